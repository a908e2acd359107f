// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <cerrno>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "farm_runs.hpp"

namespace meshfarm::test {
namespace {

TEST_CASE("a run gives every job's output, in the order asked for") {
  for (const std::size_t jobs : {0, 1, 2, 100}) {
    for (const int workers : {1, 3}) {
      CAPTURE(jobs);
      CAPTURE(workers);
      Farm farm;
      CHECK(run_farm(farm, one_stage(jobs), workers) == expected_of(jobs));
    }
  }
}

TEST_CASE("a later job is made of the outputs of those before") {
  Farm farm;
  const JobSource source = [] {
    JobGraph graph({"first", "last"});
    std::uint32_t count = 0;
    for (const Job& job : make_jobs(5)) graph.add({0, count++}, job);
    graph.add({1, 0}, {all_of(0, count)}, [](JobGraph& so_far) {
      std::string all;
      for (const AcceptedJob& each : so_far.outputs()) all += each.output.summary + ",";
      return make_job(all);
    });
    return graph;
  };
  const auto summaries = run_farm(farm, source, 2);
  REQUIRE(summaries.size() == 6);
  CHECK(summaries[5] == reversed("0 boj,1 boj,2 boj,3 boj,4 boj,"));
}

TEST_CASE("a job asked for twice is done once and given twice") {
  Farm farm;
  const JobSource source = in_stages({{make_job("a"), make_job("b"), make_job("a")}});
  std::atomic<int> count{0};
  CHECK(run_farm(farm, source, 1, counted(count)) == std::vector<std::string>{"a", "b", "a"});
  CHECK(count.load() == 2);
}

TEST_CASE("thousands of tiny jobs go through") {
  Farm farm;
  const auto start = std::chrono::steady_clock::now();
  CHECK(run_farm(farm, one_stage(3'000), 3) == expected_of(3'000));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  MESSAGE("3,000 jobs, each a synced file, in ", took.count(), " s");
}

TEST_CASE("a run that is repeated takes all from the journals") {
  Farm farm;
  DoneJobs done;
  CHECK(run_farm(farm, one_stage(50), 2, done.noting()) == expected_of(50));
  CHECK(done.take() == 50);
  SUBCASE("nothing is done again") {
    CHECK(run_farm(farm, one_stage(50), 2, done.noting()) == expected_of(50));
    CHECK(done.take() == 0);
  }
  SUBCASE("without any worker") {
    CHECK(run_farm(farm, one_stage(50), 0) == expected_of(50));
  }
  SUBCASE("but what is damaged or gone, which is done again") {
    std::vector<std::filesystem::path> files;
    for (const auto& file : std::filesystem::directory_iterator(farm.folder / "stage/results")) {
      files.push_back(file.path());
    }
    std::filesystem::remove(files.at(0));
    std::filesystem::resize_file(files.at(1), 1);
    CHECK(run_farm(farm, one_stage(50), 2, done.noting()) == expected_of(50));
    CHECK(done.take() == 2);
  }
}

TEST_CASE("an attempt that fails is made again") {
  Farm farm;
  std::atomic<int> failures{0};
  const JobFunction work = [&](const Job& job, const JobContext& context) {
    if (job.parameters == "job 1" && failures < 2) {
      if (++failures == 1) throw std::bad_alloc();
      throw IoError("cannot read", "x", 5);
    }
    return do_trivial_job(job, context);
  };
  CHECK(run_farm(farm, one_stage(3), 2, work) == expected_of(3));
  CHECK(failures == 2);
}

TEST_CASE("a job that fails for good ends the run, the others are kept") {
  Farm farm;
  std::atomic<int> attempts{0};
  std::atomic<bool> bad{false};
  const JobFunction work = [&](const Job& job, const JobContext& context) {
    if (job.parameters != "job 1") return do_trivial_job(job, context);
    ++attempts;
    if (bad) throw BadInputError("no mesh in it");
    throw DataError("no luck today");
  };
  SUBCASE("after three attempts") {
    bad = false;
  }
  SUBCASE("at once if its input is bad") {
    bad = true;
  }
  std::vector<std::string> summaries;
  Part ventilator(farm.ventilator(one_stage(10)));
  Part sink(farm.sink(one_stage(10), summaries));
  Part worker(farm.worker(work));
  const std::string why = bad ? "no mesh in it" : "no luck today";
  CHECK_THROWS_WITH_AS(ventilator.join(), doctest::Contains(why.c_str()), DataError);
  CHECK_THROWS_WITH_AS(sink.join(), doctest::Contains(why.c_str()), DataError);
  worker.join();
  CHECK(attempts == (bad ? 1 : 3));
  std::atomic<int> count{0};
  CHECK(run_farm(farm, one_stage(10), 1, counted(count)) == expected_of(10));
  CHECK(count.load() == 1);
}

TEST_CASE("a full stage is waited for, and nobody is to blame") {
  Farm farm;
  std::atomic<int> count{0};
  const JobFunction work = [&](const Job& job, const JobContext& context) {
    ++count;
    if (count >= 5 && count <= 8) throw IoError("cannot sync", "results/x", ENOSPC);
    return do_trivial_job(job, context);
  };
  CHECK(run_farm(farm, one_stage(10), 1, work) == expected_of(10));
  CHECK(count.load() == 14);
}

TEST_CASE("a full stage ends a run that shall not wait, which may be taken up again") {
  Farm farm;
  farm.when_full = WhenFull::end;
  std::atomic<int> count{0};
  const JobFunction work = [&](const Job& job, const JobContext& context) {
    if (++count == 5) throw IoError("cannot sync", "results/x", ENOSPC);
    return do_trivial_job(job, context);
  };
  std::vector<std::string> summaries;
  Part ventilator(farm.ventilator(one_stage(10)));
  Part sink(farm.sink(one_stage(10), summaries));
  Part worker(farm.worker(work));
  CHECK_THROWS_WITH_AS(ventilator.join(), doctest::Contains("make room"), IncompleteError);
  CHECK_THROWS_WITH_AS(sink.join(), doctest::Contains("results/x"), IncompleteError);
  worker.join();
  CHECK(run_farm(farm, one_stage(10), 1) == expected_of(10));
}

TEST_CASE("a ventilator that is stopped and started again goes on") {
  Farm farm;
  std::atomic<std::uint64_t> done{0};
  std::vector<std::string> summaries;
  auto first = std::make_unique<Part>(
      farm.ventilator(one_stage(300), [&](const FarmProgress& p) { done = p.jobs_done; }));
  Part sink(farm.sink(one_stage(300), summaries));
  Part worker(farm.worker(do_slow_job));
  Part other(farm.worker(do_slow_job));
  wait_until([&] { return done > 20; });
  first->stop();
  CHECK_THROWS_AS(first->join(), IncompleteError);
  Part second(farm.ventilator(one_stage(300)));
  second.join();
  sink.join();
  worker.join();
  other.join();
  CHECK(summaries == expected_of(300));
}

TEST_CASE("a worker that is stopped gives back what it holds, at once") {
  Farm farm;
  farm.heartbeat = std::chrono::milliseconds(60'000);  // so that nobody is lost by silence
  std::vector<std::string> summaries;
  std::atomic<bool> begun{false};
  const JobFunction endless = [&](const Job&, const JobContext& context) -> JobOutput {
    begun = true;
    while (context.progress(1)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw IncompleteError("given up");
  };
  Part ventilator(farm.ventilator(one_stage(4)));
  Part sink(farm.sink(one_stage(4), summaries));
  Part stopped(farm.worker(endless));
  wait_until([&] { return begun.load(); });
  stopped.stop();
  CHECK_THROWS_AS(stopped.join(), IncompleteError);
  Part worker(farm.worker());
  sink.join();
  ventilator.join();
  worker.join();
  CHECK(summaries == expected_of(4));
}

TEST_CASE("a job that hangs is taken from its worker, which is told to end its process") {
  Farm farm;
  farm.heartbeat = std::chrono::milliseconds(50);
  farm.hang = std::chrono::milliseconds(300);
  std::atomic<bool> begun{false};
  std::atomic<bool> ended{false};
  std::string why;
  const JobFunction hangs = [&](const Job&, const JobContext&) -> JobOutput {
    begun = true;
    while (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    throw IncompleteError("the test lets it go");
  };
  std::vector<std::string> summaries;
  std::atomic<std::uint32_t> lost{0};
  Part ventilator(
      farm.ventilator(one_stage(3), [&](const FarmProgress& p) { lost = p.workers_lost; }));
  Part sink(farm.sink(one_stage(3), summaries));
  Part hung([&](const std::atomic<bool>& stop) {
    WorkerOptions options;
    options.stop = &stop;
    options.abort = [&](const std::string& reason) {
      why = reason;
      ended = true;  // as the end of the process would
    };
    run_worker(farm.stage, hangs, options);
  });
  wait_until([&] { return ended.load(); });
  CHECK_THROWS_AS(hung.join(), IncompleteError);
  CHECK(begun);
  CHECK(why.find("stood still") != std::string::npos);
  // On a busy host the next worker may stand still, too: then another one is started.
  Part workers([&](const std::atomic<bool>& stop) {
    for (bool done = false; !done && !stop;) {
      try {
        farm.worker()(stop);
        done = true;
      } catch (const IncompleteError&) {
      }
    }
  });
  sink.join();
  ventilator.join();
  workers.stop();
  workers.join();
  CHECK(lost >= 1);
  CHECK(summaries == expected_of(3));
}

TEST_CASE("a worker of many threads works on as many jobs at once") {
  Farm farm;
  std::atomic<int> now{0};
  std::atomic<int> most{0};
  const JobFunction work = [&](const Job& job, const JobContext& context) {
    const int at_once = ++now;
    for (int seen = most; seen < at_once && !most.compare_exchange_weak(seen, at_once);) {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    --now;
    return do_trivial_job(job, context);
  };
  std::vector<std::string> summaries;
  Part ventilator(farm.ventilator(one_stage(40)));
  Part sink(farm.sink(one_stage(40), summaries));
  Part worker([&](const std::atomic<bool>& stop) {
    WorkerOptions options;
    options.capacity.threads = 4;
    options.stop = &stop;
    CHECK(run_worker(farm.stage, work, options).jobs_done == 40);
  });
  sink.join();
  ventilator.join();
  worker.join();
  CHECK(summaries == expected_of(40));
  CHECK(most == 4);
}

TEST_CASE("whoever finds no ventilator says what to start") {
  Farm farm;
  farm.patience = std::chrono::milliseconds(300);
  std::vector<std::string> summaries;
  Part worker(farm.worker());
  Part sink(farm.sink(one_stage(1), summaries));
  CHECK_THROWS_WITH_AS(worker.join(), doctest::Contains("start 'meshfarm"), IncompleteError);
  CHECK_THROWS_WITH_AS(sink.join(), doctest::Contains("start 'meshfarm"), IncompleteError);
}

}  // namespace
}  // namespace meshfarm::test
