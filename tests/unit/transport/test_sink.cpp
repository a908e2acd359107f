// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <cerrno>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/util/log.hpp>

#include "farm_runs.hpp"

namespace meshfarm::test {
namespace {

TEST_CASE("an accepted output that the source cannot read any more is set aside and made again") {
  Farm farm;
  // As the journal of another build may hold it: all files are whole, but one summary is
  // meaningless.
  const JobFunction garbled = [](const Job& job, const JobContext& context) {
    JobOutput output = do_trivial_job(job, context);
    if (job.parameters == "job 3") output.summary = "garbled";
    return output;
  };
  run_farm(farm, one_stage(5), 1, garbled);
  const auto inspect = [](std::string_view, const JobOutput& output) {
    if (output.summary == "garbled") throw DataError("a summary of another version");
  };
  std::atomic<int> count{0};
  std::vector<std::string> summaries;
  Part ventilator(farm.ventilator(one_stage(5)));
  Part sink(farm.sink(one_stage(5), summaries, inspect));
  Part worker(farm.worker(counted(count)));
  sink.join();
  ventilator.join();
  worker.join();
  CHECK(summaries == expected_of(5));
  CHECK(count == 1);
}

TEST_CASE("results are accepted while the sink does a job of its own, which may be done again") {
  Farm farm;
  set_log("test", LogLevel::off);
  const JobSource source = [] {
    std::vector<Job> jobs = make_jobs(6);
    jobs.back().by_sink = true;
    return in_stages({jobs})();
  };
  std::atomic<std::uint64_t> done{0};
  Part ventilator(farm.ventilator(source, [&](const FarmProgress& p) { done = p.jobs_done; }));
  Part worker(farm.worker());
  int tries = 0;
  std::size_t outputs = 0;
  Part sink([&](const std::atomic<bool>& stop) {
    SinkOptions options;
    options.run = farm.run;
    options.stop = &stop;
    options.do_here = [&](const Job& job, const JobContext& context, std::span<const AcceptedJob>) {
      wait_until([&] { return done == 5; });
      if (++tries < 2) throw IoError("cannot write", "out.ply", ENOSPC);
      return do_trivial_job(job, context);
    };
    run_sink(farm.stage, source, options,
             [&](std::span<const AcceptedJob> accepted) { outputs = accepted.size(); });
  });
  sink.join();
  ventilator.join();
  worker.join();
  set_log("test", LogLevel::info);
  CHECK(tries == 2);
  CHECK(outputs == 6);
}

TEST_CASE("an output that there is no room for is made when there is") {
  Farm farm;
  set_log("test", LogLevel::off);
  Part ventilator(farm.ventilator(one_stage(3)));
  Part worker(farm.worker());
  int tries = 0;
  Part sink([&](const std::atomic<bool>& stop) {
    SinkOptions options;
    options.run = farm.run;
    options.stop = &stop;
    run_sink(farm.stage, one_stage(3), options, [&](std::span<const AcceptedJob>) {
      if (++tries < 3) throw IoError("cannot write", "out.ply", EDQUOT);
    });
  });
  sink.join();
  ventilator.join();
  worker.join();
  set_log("test", LogLevel::info);
  CHECK(tries == 3);
}

TEST_CASE("an error in making the output reaches sink and ventilator") {
  Farm farm;
  int error_number = EIO;
  SUBCASE("whatever it is") {}
  SUBCASE("a full disk, which may have room later") {
    error_number = ENOSPC;
  }
  Part ventilator(farm.ventilator(one_stage(3)));
  Part worker(farm.worker());
  Part sink([&](const std::atomic<bool>& stop) {
    SinkOptions options;
    options.run = farm.run;
    options.when_full = WhenFull::end;
    options.stop = &stop;
    run_sink(farm.stage, one_stage(3), options, [&](std::span<const AcceptedJob>) {
      throw IoError("cannot write", "out.ply", error_number);
    });
  });
  if (error_number == ENOSPC) {
    CHECK_THROWS_WITH_AS(sink.join(), doctest::Contains("out.ply"), IncompleteError);
    CHECK_THROWS_WITH_AS(ventilator.join(), doctest::Contains("make room"), IncompleteError);
  } else {
    CHECK_THROWS_WITH_AS(sink.join(), doctest::Contains("out.ply"), IoError);
    CHECK_THROWS_WITH_AS(ventilator.join(), doctest::Contains("out.ply"), DataError);
  }
  worker.join();
}

TEST_CASE("a sink that is stopped while it makes its output tells of the stop alone") {
  Farm farm;
  std::atomic<bool> making{false};
  Part ventilator(farm.ventilator(one_stage(3)));
  Part worker(farm.worker());
  Part sink([&](const std::atomic<bool>& stop) {
    SinkOptions options;
    options.run = farm.run;
    options.stop = &stop;
    run_sink(farm.stage, one_stage(3), options, [&](std::span<const AcceptedJob>) {
      making = true;
      while (!stop) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      throw IoError("cannot write", "out.ply", EIO);
    });
  });
  wait_until([&] { return making.load(); });
  sink.stop();
  CHECK_THROWS_WITH_AS(sink.join(), doctest::Contains("stopped"), IncompleteError);
  std::vector<std::string> summaries;
  Part second(farm.sink(one_stage(3), summaries));
  second.join();
  ventilator.join();
  worker.join();
  CHECK(summaries == expected_of(3));
}

TEST_CASE("a sink that is stopped and started again goes on") {
  Farm farm;
  // No second attempts, and no worker declared lost on a busy machine: each job is done once.
  farm.schedule = {.schedule = Schedule::fixed, .expect_workers = 2};
  farm.heartbeat = std::chrono::seconds(10);
  std::atomic<std::uint64_t> done{0};
  std::atomic<int> count{0};
  const JobFunction work = [&](const Job& job, const JobContext& context) {
    ++count;
    return do_slow_job(job, context);
  };
  Part ventilator(
      farm.ventilator(one_stage(300), [&](const FarmProgress& p) { done = p.jobs_done; }));
  std::vector<std::string> none;
  std::vector<std::string> summaries;
  auto first = std::make_unique<Part>(farm.sink(one_stage(300), none));
  Part worker(farm.worker(work));
  Part other(farm.worker(work));
  wait_until([&] { return done > 20; });
  first->stop();
  CHECK_THROWS_AS(first->join(), IncompleteError);
  Part second(farm.sink(one_stage(300), summaries));
  second.join();
  ventilator.join();
  worker.join();
  other.join();
  CHECK(none.empty());
  CHECK(summaries == expected_of(300));
  CHECK(count == 300);  // results made while there was no sink were sent again, not made again
}

TEST_CASE("a sink of another run is not served") {
  Farm farm;
  farm.patience = std::chrono::milliseconds(500);
  Part ventilator(farm.ventilator(one_stage(1)));
  farm.run = 8;
  std::vector<std::string> summaries;
  Part sink(farm.sink(one_stage(1), summaries));
  CHECK_THROWS_AS(sink.join(), IncompleteError);
  ventilator.stop();
  CHECK_THROWS_AS(ventilator.join(), IncompleteError);
}

}  // namespace
}  // namespace meshfarm::test
