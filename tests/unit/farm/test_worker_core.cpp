// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/worker_core.hpp>

#include "support/jobs.hpp"

namespace meshfarm::test {
namespace {

template <class A>
std::vector<A> only_action(const WorkerActions& actions) {
  std::vector<A> found;
  for (const WorkerAction& action : actions) {
    if (const auto* each = std::get_if<A>(&action)) found.push_back(*each);
  }
  return found;
}

/// The last credit announced among the actions; 0 if there is none.
std::uint64_t credit_in(const WorkerActions& actions) {
  std::uint64_t credit = 0;
  for (const Say& say : only_action<Say>(actions)) {
    if (const auto* each = std::get_if<Credit>(&say.message)) credit = each->up_to;
  }
  return credit;
}

Endpoint endpoint(std::uint32_t epoch) {
  return {epoch, 7, "tcp://v:" + std::to_string(epoch), "h", 1};
}

/// A worker with a clock.
struct WorkerBench {
  explicit WorkerBench(std::uint32_t buffer = 5, std::uint32_t slots = 1, std::uint64_t memory = 0)
      : core({Role::worker, 0, 99, 1, "h", {}, FarmTime(10'000)}, {buffer, slots, memory}) {}

  WorkerActions join(std::uint32_t epoch, const std::string& sink = "sink") {
    core.tick({}, now);
    const Endpoint there = endpoint(epoch);
    CHECK(only_action<Dial>(core.found({&there, 1}, now)).size() == 1);
    return core.on_control(Welcome{{epoch}, epoch, 7, "lane", sink, 1000}, now);
  }
  WorkerActions job(std::uint64_t seq, const std::string& name, std::uint32_t attempt = 1,
                    std::uint32_t epoch = 1) {
    return core.on_lane(Assignment{7, epoch, seq, attempt, make_job(name)}, now);
  }
  WorkerActions finish(std::uint32_t slot = 0) {
    return core.finished(slot, JobFailure{"tried", FailureKind::attempt}, now);
  }

  WorkerCore core;
  FarmTime now{0};
};

TEST_CASE("a batch is asked for when the buffer is less than 0.8 full") {
  WorkerBench bench(5);
  CHECK(credit_in(bench.join(1)) == 6);  // one in work, and five waiting
  CHECK(only_action<Begin>(bench.job(1, "1")).size() == 1);
  for (std::uint64_t seq = 2; seq <= 6; ++seq)
    CHECK(only_action<Begin>(bench.job(seq, "x")).empty());
  CHECK(bench.core.waiting() == 5);
  CHECK(credit_in(bench.finish()) == 0);  // 4 of 5 wait: that is 0.8, not less
  CHECK(credit_in(bench.finish()) == 8);  // 3 of 5 wait, one is in work: room for two more
}

TEST_CASE("without a buffer a job is asked for when there is none") {
  WorkerBench bench(0);
  CHECK(credit_in(bench.join(1)) == 1);
  CHECK(credit_in(bench.job(1, "1")) == 0);
  CHECK(credit_in(bench.finish()) == 2);
}

TEST_CASE("a repeated job is dropped, a gap in the lane makes the worker join again") {
  WorkerBench bench;
  bench.join(1);
  bench.job(1, "1");
  CHECK(bench.job(1, "1").empty());
  CHECK(bench.core.dropped() == 1);
  CHECK(only_action<HangUp>(bench.job(3, "3")).size() == 1);
  CHECK(bench.core.waiting() == 0);
}

TEST_CASE("a result is kept, and said again, until it is done") {
  WorkerBench bench;
  bench.join(1);
  bench.job(1, "1", 5);
  const auto results = only_action<SendResult>(bench.finish());
  REQUIRE(results.size() == 1);
  CHECK(results[0].result.epoch == 1);
  CHECK(results[0].result.attempt == 5);
  const JobKey key = results[0].result.key;
  bench.now += FarmTime(2500);
  bench.core.on_control(Alive{1, "sink"}, bench.now);
  CHECK(only_action<SendResult>(bench.core.tick({}, bench.now)).empty());
  bench.now += FarmTime(2500);
  CHECK(only_action<SendResult>(bench.core.tick({}, bench.now)).size() == 1);
  bench.core.on_control(Done{key, 4}, bench.now);  // refers to an earlier attempt
  CHECK(bench.core.unacknowledged() == 1);
  bench.core.on_control(Done{key, 5}, bench.now);
  CHECK(bench.core.unacknowledged() == 0);
}

TEST_CASE("a new sink is told at once what is not acknowledged") {
  WorkerBench bench;
  bench.join(1, "");
  bench.job(1, "1");
  CHECK(only_action<SendResult>(bench.finish()).empty());  // there is nobody to tell
  const WorkerActions told = bench.core.on_control(SinkAt{"sink"}, bench.now);
  REQUIRE(only_action<ConnectSink>(told).size() == 1);
  CHECK(only_action<ConnectSink>(told)[0].address == "sink");
  CHECK(only_action<SendResult>(told).size() == 1);
}

TEST_CASE("Done takes a job from the buffer or from work, but not a later attempt at it") {
  WorkerBench bench;
  bench.join(1);
  const JobKey one = key_of(make_job("1"));
  bench.job(1, "1", 1);
  bench.job(2, "2", 1);
  bench.job(3, "1", 2);
  CHECK(bench.core.waiting() == 2);
  CHECK(only_action<GiveUp>(bench.core.on_control(Done{one, 1}, bench.now)).size() == 1);
  CHECK(bench.core.waiting() == 2);
  bench.core.on_control(Done{key_of(make_job("2")), 9}, bench.now);
  CHECK(bench.core.waiting() == 1);
  const WorkerActions ended = bench.finish();
  CHECK(only_action<SendResult>(ended).empty());  // nobody wants it
  REQUIRE(only_action<Begin>(ended).size() == 1);
  CHECK(only_action<Begin>(ended)[0].attempt == 2);
}

TEST_CASE("a worker looks for a ventilator at once and often, then less and less") {
  WorkerBench bench;
  std::vector<FarmTime::rep> looks;
  while (bench.now < FarmTime(5000)) {
    if (!only_action<Look>(bench.core.tick({}, bench.now)).empty())
      looks.push_back(bench.now.count());
    CHECK(bench.core.pause(bench.now) >= FarmTime(1));
    CHECK(bench.core.pause(bench.now) <= FarmTime(100));
    bench.now += bench.core.pause(bench.now);
  }
  REQUIRE(looks.size() > 8);
  CHECK(looks.size() < 20);
  CHECK(looks[0] == 0);
  CHECK(looks[2] == 15);
  CHECK(looks.back() - looks[looks.size() - 2] >= 500);

  // A ventilator that was found is given time to answer.
  const Endpoint there = endpoint(1);
  CHECK(only_action<Dial>(bench.core.found({&there, 1}, bench.now)).size() == 1);
  CHECK(only_action<Look>(bench.core.tick({}, bench.now + FarmTime(45))).empty());
  CHECK(only_action<Look>(bench.core.tick({}, bench.now + FarmTime(55))).size() == 1);
}

TEST_CASE("a ventilator that falls silent is replaced; what was done is kept, what waits is not") {
  WorkerBench bench;
  bench.join(1);
  bench.job(1, "1");
  bench.job(2, "2");
  bench.job(3, "3");
  bench.finish();
  bench.now += FarmTime(3001);
  const WorkerActions lost = bench.core.tick({}, bench.now);
  CHECK(only_action<HangUp>(lost).size() == 1);
  CHECK(only_action<Look>(lost).size() == 1);
  CHECK(bench.core.waiting() == 0);
  const WorkerActions joined = bench.join(2);
  REQUIRE(only_action<SendResult>(joined).size() == 1);
  CHECK(only_action<SendResult>(joined)[0].result.epoch == 2);
  CHECK(credit_in(joined) == 5);  // one of the six places is taken by the job still in work
  CHECK(bench.job(1, "1", 1, 1).empty());  // the old epoch's lane
  CHECK(bench.core.dropped() == 1);
}

TEST_CASE("patience ends, the run ends, and a stop gives back") {
  WorkerBench bench;
  SUBCASE("no ventilator") {
    bench.core.tick({}, bench.now);
    const auto left = only_action<Leave>(bench.core.tick({}, bench.now + FarmTime(10'001)));
    REQUIRE(left.size() == 1);
    CHECK(left[0].incomplete.find("meshfarm run") != std::string::npos);
  }
  SUBCASE("over") {
    bench.join(1);
    const auto left =
        only_action<Leave>(bench.core.on_control(Stop{StopReason::run_over}, bench.now));
    REQUIRE(left.size() == 1);
    CHECK(left[0].incomplete.empty());
  }
  SUBCASE("over, as the stage says") {
    bench.join(1);
    bench.now += FarmTime(3001);
    bench.core.tick({}, bench.now);
    const std::vector<Endpoint> seen = {endpoint(1), {2, 7, "", "h", 1}};
    const auto left = only_action<Leave>(bench.core.found(seen, bench.now));
    REQUIRE(left.size() == 1);
    CHECK(left[0].incomplete.empty());
  }
  SUBCASE("over before it came: it waits for the next run") {
    const std::vector<Endpoint> seen = {endpoint(1), {2, 7, "", "h", 1}};
    CHECK(bench.core.found(seen, bench.now).empty());
  }
  SUBCASE("stopped while it works: it leaves once the job ended") {
    bench.join(1);
    bench.job(1, "1");
    const WorkerActions stopping = bench.core.stop();
    REQUIRE(only_action<Say>(stopping).size() == 1);
    CHECK(std::holds_alternative<Release>(only_action<Say>(stopping)[0].message));
    CHECK(only_action<GiveUp>(stopping).size() == 1);
    CHECK(only_action<Leave>(stopping).empty());
    CHECK(only_action<Leave>(bench.finish()).size() == 1);
  }
  SUBCASE("stopped while it works, and the job does not listen: the process must end") {
    bench.join(1);
    bench.job(1, "1");
    bench.core.stop();
    CHECK(bench.core.tick({}, bench.now).empty());
    CHECK(bench.core.tick({}, bench.now + FarmTime(5000)).empty());
    const auto aborted = only_action<Leave>(bench.core.tick({}, bench.now + FarmTime(5001)));
    REQUIRE(aborted.size() == 1);
    CHECK(aborted[0].abort);
    CHECK(aborted[0].incomplete.find("given back") != std::string::npos);
  }
  SUBCASE("told that it hangs") {
    bench.join(1);
    bench.job(1, "1");
    CHECK(only_action<Leave>(bench.core.on_control(Stop{StopReason::hung}, bench.now)).size() == 1);
  }
}

TEST_CASE("as many jobs are in work as there are slots and memory") {
  SUBCASE("three slots") {
    WorkerBench bench(2, 3);
    CHECK(credit_in(bench.join(1)) == 5);
    for (std::uint64_t seq = 1; seq <= 3; ++seq) {
      const auto begun = only_action<Begin>(bench.job(seq, std::to_string(seq)));
      REQUIRE(begun.size() == 1);
      CHECK(begun[0].slot == seq - 1);
    }
    CHECK(only_action<Begin>(bench.job(4, "4")).empty());
    const WorkerActions ended = bench.finish(1);
    REQUIRE(only_action<Begin>(ended).size() == 1);
    CHECK(only_action<Begin>(ended)[0].slot == 1);
    CHECK(credit_in(ended) == 6);
  }
  SUBCASE("a job waits for memory, but the first never") {
    WorkerBench bench(2, 2, 100);
    bench.join(1);
    const auto send = [&](std::uint64_t seq, std::uint64_t memory) {
      Job job = make_job(std::to_string(seq));
      job.memory = memory;
      return only_action<Begin>(bench.core.on_lane(Assignment{7, 1, seq, 1, job}, bench.now))
          .size();
    };
    CHECK(send(1, 150) == 1);
    CHECK(send(2, 60) == 0);
    CHECK(only_action<Begin>(bench.finish(0)).size() == 1);
    CHECK(send(3, 50) == 0);
    CHECK(only_action<Begin>(bench.finish(0)).size() == 1);
    CHECK(send(4, 50) == 1);
  }
}

TEST_CASE("a worker that shares its host's memory keeps to its share") {
  WorkerBench bench(2, 3, 100);
  bench.core.tick({}, bench.now);
  const Endpoint there = endpoint(1);
  bench.core.found({&there, 1}, bench.now);
  bench.core.on_control(Welcome{{1}, 1, 7, "lane", "sink", 1000, 50}, bench.now);
  const auto send = [&](std::uint64_t seq) {
    Job job = make_job(std::to_string(seq));
    job.memory = 30;
    return only_action<Begin>(bench.core.on_lane(Assignment{7, 1, seq, 1, job}, bench.now)).size();
  };
  CHECK(send(1) == 1);
  CHECK(send(2) == 0);
  // Another worker has left: there is room for two.
  const WorkerActions more = bench.core.on_control(Alive{1, "sink", 100}, bench.now);
  CHECK(only_action<Begin>(more).size() == 1);
}

TEST_CASE("a worker whose every slot waits for storage asks for nothing until one is free") {
  WorkerBench bench(2, 2);
  bench.join(1);
  bench.job(1, "1");
  bench.job(2, "2");
  bench.core.tick({{{1, JobPhase::storage}, {1, JobPhase::storage}}}, bench.now);
  bench.core.on_control(Refused{Refusal::stranger, "it waits for the stage"}, bench.now);
  CHECK(credit_in(bench.join(2)) == 0);
  SUBCASE("by the end of a job") {
    CHECK(credit_in(bench.finish(0)) > 0);
  }
  SUBCASE("or as its job goes on to be computed") {
    const WorkerPulse moving{{{1, JobPhase::computing}, {1, JobPhase::storage}}};
    CHECK(credit_in(bench.core.tick(moving, bench.now)) > 0);
  }
}

Heartbeat beat_in(const WorkerActions& actions) {
  for (const Say& say : only_action<Say>(actions)) {
    if (const auto* beat = std::get_if<Heartbeat>(&say.message)) return *beat;
  }
  FAIL("no heartbeat");
  return {};
}

TEST_CASE("what the sink cannot read is tried, and what came of it is told") {
  WorkerBench bench;
  bench.join(1);
  const FileRef file{"results/x", 5, 6};
  const auto reads =
      only_action<ReadForSink>(bench.core.on_control(TryRead{{4}, 3, file}, bench.now));
  REQUIRE(reads.size() == 1);
  CHECK(reads[0].what.file == file);
  const auto said = only_action<Say>(bench.core.tried(reads[0].what, true));
  REQUIRE(said.size() == 1);
  const auto& tried = std::get<TriedRead>(said[0].message);
  CHECK(tried.epoch == 1);
  CHECK(tried.worker == WorkerId{1});
  CHECK(tried.key == JobKey{4});
  CHECK(tried.attempt == 3);
  CHECK(tried.whole);
}

TEST_CASE("a heartbeat tells of the job that stands still the longest") {
  WorkerBench bench(5, 2);
  bench.join(1);
  bench.job(1, "1");
  bench.job(2, "2");
  using enum JobPhase;
  bench.core.tick({{{1, computing}, {1, waiting}}}, bench.now);
  const auto beat = [&](const std::vector<SlotPulse>& slots) {
    bench.now += FarmTime(1000);
    bench.core.on_control(Alive{1, "sink"}, bench.now);
    return beat_in(bench.core.tick({slots, 8}, bench.now));
  };
  Heartbeat told = beat({{2, computing}, {1, waiting}});
  CHECK(told.still_ms == 0);
  CHECK(told.progress == 3);
  CHECK(told.rss_bytes == 8);
  told = beat({{2, computing}, {1, waiting}});
  CHECK(told.still_ms == 1000);
  CHECK(told.still == key_of(make_job("1")));
  CHECK_FALSE(told.in_storage);
  told = beat({{3, computing}, {1, storage}});
  CHECK(told.still_ms == 0);
  beat({{4, computing}, {1, storage}});
  told = beat({{4, computing}, {1, storage}});
  CHECK(told.still_ms == 2000);
  CHECK(told.still == key_of(make_job("2")));
  CHECK(told.in_storage);
  CHECK(beat({}).still_ms == 0);  // nothing is known about the slots
  // A ventilator that took the jobs back is not told of them again.
  bench.core.on_control(Refused{Refusal::stranger, "it waits for the stage"}, bench.now);
  bench.join(2);
  bench.now += FarmTime(1000);
  bench.core.on_control(Alive{2, "sink"}, bench.now);
  CHECK(beat_in(bench.core.tick({{{5, computing}, {1, storage}}, 8}, bench.now)).still_ms == 0);
}

TEST_CASE("a job that gets little of a busy processor is judged by what it gets") {
  WorkerBench bench(5, 1);
  bench.join(1);
  bench.job(1, "1");
  const auto still = [&](const SlotPulse& pulse) {
    bench.now += FarmTime(10'000);
    bench.core.on_control(Alive{1, "sink"}, bench.now);
    return beat_in(bench.core.tick({{pulse}, 8}, bench.now)).still_ms;
  };
  using enum JobPhase;
  CHECK(still({1, computing, 500}) == 0);
  CHECK(still({1, computing, 700}) == 200);
  CHECK(still({1, computing, 20'000}) == 19'500);
  CHECK(still({2, computing, 21'000}) == 0);
  CHECK(still({2, computing, 40'000}) == 10'000);  // more than there was: of two clocks
  // A slot that waits for a lock, then for the stage.
  CHECK(still({3, computing, 40'000}) == 0);
  CHECK(still({3, computing, 40'009}) == 10'000);
  CHECK(still({3, storage, 50'000}) == 0);
  CHECK(still({3, storage, 50'100}) == 10'000);
  CHECK(still({3, storage}) == 20'000);
}

}  // namespace
}  // namespace meshfarm::test
