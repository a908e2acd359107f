// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "sink_bench.hpp"

namespace meshfarm::test {
namespace {

TEST_CASE("a result is told only after its file is found whole and journalled") {
  SinkBench bench(2);
  bench.join(1);
  const auto checks = only<Check>(bench.result(key("job 1")));
  REQUIRE(checks.size() == 1);
  CHECK(checks[0].what == Check::What::result);
  CHECK(checks[0].attempt == 1);
  CHECK(only<Check>(bench.result(key("job 1"))).empty());  // repeated while it is being checked
  const auto accepts = said<Accept>(bench.core.checked(checks[0], {}, bench.now));
  REQUIRE(accepts.size() == 1);
  CHECK(accepts[0].worker == WorkerId{3});
  CHECK(accepts[0].times.compute_ms == 3);
  const SinkActions again = bench.result(key("job 1"));  // the worker missed the answer
  CHECK(only<Check>(again).empty());
  CHECK(said<Accept>(again).size() == 1);
  CHECK(bench.core.graph().jobs_accepted() == 1);
}

TEST_CASE("a damaged result and a failed job are rejected with their reasons") {
  SinkBench bench(2);
  bench.join(1);
  const auto checks = only<Check>(bench.result(key("job 0"), 1, 4));
  const auto damaged = said<Reject>(bench.core.checked(checks.at(0), {"it is damaged"}, bench.now));
  REQUIRE(damaged.size() == 1);
  CHECK(damaged[0].attempt == 4);
  CHECK(damaged[0].failure.reason == "it is damaged");
  CHECK(damaged[0].failure.kind == FailureKind::attempt);
  CHECK(damaged[0].file == checks.at(0).output.file);  // so that another reader can try it
  const JobFailure full{"no room", FailureKind::no_space};
  const auto failed =
      said<Reject>(bench.core.on_result(Result{7, 1, {3}, 5, 1, key("job 1"), full, {}}));
  REQUIRE(failed.size() == 1);
  CHECK(failed[0].failure.kind == FailureKind::no_space);
  CHECK(failed[0].file.name.empty());
  CHECK(bench.core.graph().jobs_accepted() == 0);
}

TEST_CASE("what is not ours is dropped and counted") {
  SinkBench bench(1);
  bench.join(2);
  const JobKey job = key("job 0");
  const JobOutput good = result_of(job);
  CHECK(bench.core.on_result(Result{8, 2, {3}, 5, 1, job, good, {}}).empty());  // another run
  CHECK(bench.core.on_result(Result{7, 1, {3}, 5, 1, job, good, {}}).empty());  // an old epoch
  CHECK(bench.core.on_result(Result{7, 2, {3}, 5, 1, {1}, good, {}}).empty());  // not wanted
  CHECK(bench.core.on_result(Result{7, 2, {3}, 6, 1, job, good, {}}).empty());  // another's file
  CHECK(bench.core.on_result(Result{7, 2, {3}, 5, 2, job, good, {}}).empty());  // not its attempt
  CHECK(bench.core.on_result(Complete{2}).empty());
  CHECK(bench.core.dropped() == 6);
  CHECK(only<Check>(bench.result(job, 2)).size() == 1);
}

TEST_CASE("what a journal knows is looked at, and told to each ventilator before Ready") {
  const JobKey known = key("job 0");
  const JobKey gone = key("job 1");
  SinkBench bench(3, {{known, result_of(known)}, {gone, result_of(gone)}, {{1}, result_of({1})}});
  const auto checks = only<Check>(bench.join(1));
  REQUIRE(checks.size() == 2);  // a result that belongs to no job is left alone
  CHECK(checks[0].what == Check::What::known);
  CHECK(said<Ready>(bench.core.checked(checks[0], {}, bench.now))
            .empty());  // one is still being checked
  const SinkActions told = bench.core.checked(checks[1], {"it is not there"}, bench.now);
  CHECK(said<Reject>(told).empty());
  CHECK(said<Accept>(told).size() == 1);
  REQUIRE(said<Ready>(told).size() == 1);
  CHECK(said<Ready>(told)[0].accepted == 1);
  CHECK(said<Ready>(told)[0].unverified == 1);
  CHECK(said<Accept>(bench.accept(key("job 2"))).size() == 1);

  bench.now += FarmTime(3001);
  CHECK(only<HangUp>(bench.core.tick(bench.now)).size() == 1);
  const SinkActions anew = bench.join(2);
  CHECK(said<Accept>(anew).size() == 2);
  CHECK(said<Ready>(anew).at(0).accepted == 2);
}

TEST_CASE("heartbeats say again where the sink stands") {
  SinkBench bench(2);
  bench.join(1);
  bench.accept(key("job 0"));
  const SinkActions beat = bench.silence(FarmTime(1000));
  CHECK(said<Heartbeat>(beat).size() == 1);
  CHECK(said<Ready>(beat).at(0).accepted == 1);
}

TEST_CASE("the output is made once all is accepted, and Complete said until it is heard") {
  SinkBench bench(1);
  bench.join(1);
  CHECK(only<MakeOutput>(bench.accept(key("job 0"))).size() == 1);
  bench.core.on_control(Alive{1, ""}, bench.now);
  CHECK(said<Complete>(bench.core.completed({}, bench.now)).size() == 1);
  CHECK(said<Complete>(bench.silence(FarmTime(1000))).size() == 1);
  SUBCASE("the ventilator ends the run") {
    const auto left =
        only<SinkLeaves>(bench.core.on_control(Stop{StopReason::run_over}, bench.now));
    REQUIRE(left.size() == 1);
    CHECK(left[0].why == SinkLeaves::Why::complete);
    CHECK(left[0].message.empty());
  }
  SUBCASE("nobody answers any more: it is complete all the same") {
    SinkActions last;
    for (int i = 0; i < 15 && only<SinkLeaves>(last).empty(); ++i) {
      last = bench.silence(FarmTime(1000));
    }
    REQUIRE(only<SinkLeaves>(last).size() == 1);
    CHECK(only<SinkLeaves>(last)[0].why == SinkLeaves::Why::complete);
    CHECK_FALSE(only<SinkLeaves>(last)[0].message.empty());
  }
}

TEST_CASE("an output or a journal that cannot be written is told, and is the end") {
  SinkBench bench(1);
  bench.join(1);
  bool resumable = false;
  SUBCASE("for good") {}
  SUBCASE("for now: the disk is full") {
    resumable = true;
  }
  const auto told = said<Failed>(bench.core.fail({"cannot write", resumable}));
  REQUIRE(told.size() == 1);
  CHECK(told[0].reason == "cannot write");
  CHECK(told[0].resumable == resumable);
  const auto left = only<SinkLeaves>(bench.core.on_control(Stop{StopReason::run_over}, bench.now));
  REQUIRE(left.size() == 1);
  CHECK(left[0].message == "cannot write");
  CHECK(left[0].why == (resumable ? SinkLeaves::Why::incomplete : SinkLeaves::Why::output_failed));
}

TEST_CASE("a record that there is no room for is written again, and told only then") {
  SinkBench bench(1);
  bench.join(1);
  const auto checks = only<Check>(bench.result(key("job 0")));
  REQUIRE(checks.size() == 1);
  const JobFailure full{"ENOSPC", FailureKind::no_space};
  CHECK(bench.core.checked(checks[0], full, bench.now).empty());  // nobody is to blame
  CHECK(bench.core.waits_for_room());
  CHECK(only<Check>(bench.result(key("job 0"))).empty());
  const SinkActions beats = bench.silence(FarmTime(900));
  REQUIRE(said<Heartbeat>(beats).size() == 1);
  CHECK(said<Heartbeat>(beats)[0].no_room);
  const auto again = only<Check>(bench.silence(FarmTime(100)));
  REQUIRE(again.size() == 1);
  CHECK(again[0].what == Check::What::result);
  const SinkActions told = bench.core.checked(again[0], {}, bench.now);
  CHECK(said<Accept>(told).size() == 1);
  CHECK(only<MakeOutput>(told).size() == 1);
  CHECK_FALSE(bench.core.waits_for_room());
}

TEST_CASE("a sink does not wait for room when what it had none for is damaged by then") {
  SinkBench bench(2);
  bench.join(1);
  const auto checks = only<Check>(bench.result(key("job 0")));
  const auto more = only<Check>(bench.result(key("job 1")));
  const JobFailure full{"ENOSPC", FailureKind::no_space};
  bench.core.checked(checks.at(0), full, bench.now);
  bench.core.checked(more.at(0), full, bench.now);
  const auto again = only<Check>(bench.silence(FarmTime(1000)));
  REQUIRE(again.size() == 2);
  const JobFailure damaged{"it is damaged", FailureKind::attempt};
  CHECK(said<Reject>(bench.core.checked(again[0], damaged, bench.now)).size() == 1);
  CHECK(bench.core.waits_for_room());  // the other one may still find no room
  CHECK(said<Reject>(bench.core.checked(again[1], damaged, bench.now)).size() == 1);
  CHECK_FALSE(bench.core.waits_for_room());
}

TEST_CASE("an output that there is no room for is made again") {
  SinkBench bench(1);
  bench.join(1);
  CHECK(only<MakeOutput>(bench.accept(key("job 0"))).size() == 1);
  const SinkProblem full{"ENOSPC", true};
  for (const int pause : {1000, 2000}) {
    CHECK(said<Failed>(bench.core.completed(full, bench.now)).empty());
    CHECK(bench.core.waits_for_room());
    CHECK(only<MakeOutput>(bench.silence(FarmTime(pause - 1))).empty());
    bench.core.on_control(Alive{1, {}}, bench.now);
    CHECK(only<MakeOutput>(bench.silence(FarmTime(1))).size() == 1);
  }
  CHECK(said<Complete>(bench.core.completed({}, bench.now)).size() == 1);
  CHECK_FALSE(bench.core.waits_for_room());
}

TEST_CASE("a sink that shall not wait for room ends the run") {
  SinkBench bench(1, {}, WhenFull::end);
  bench.join(1);
  SUBCASE("for its journal") {
    const auto checks = only<Check>(bench.result(key("job 0")));
    const JobFailure full{"ENOSPC", FailureKind::no_space};
    CHECK(said<Failed>(bench.core.checked(checks.at(0), full, bench.now)).size() == 1);
  }
  SUBCASE("for the output") {
    bench.accept(key("job 0"));
    CHECK(said<Failed>(bench.core.completed({"ENOSPC", true}, bench.now)).size() == 1);
  }
}

TEST_CASE("a job of the sink is done there, verified, journalled and told as others are") {
  SinkBench bench(then_own());
  bench.join(1);
  const auto to_do = only<DoHere>(bench.accept(key("job 0")));
  REQUIRE(to_do.size() == 1);
  CHECK(to_do[0].key == key("own"));
  CHECK(to_do[0].job.by_sink);
  const SinkActions done = bench.core.did(to_do[0], result_of(key("own")), {}, bench.now);
  CHECK(said<Accept>(done).empty());
  const auto checks = only<Check>(done);
  REQUIRE(checks.size() == 1);
  CHECK(checks[0].what == Check::What::result);
  const SinkActions accepted = bench.core.checked(checks[0], {}, bench.now);
  const auto accepts = said<Accept>(accepted);
  REQUIRE(accepts.size() == 1);
  CHECK(accepts[0].key == key("own"));
  CHECK(accepts[0].worker == WorkerId{});
  CHECK(only<MakeOutput>(accepted).size() == 1);
  // No worker would repeat it if the ventilator did not hear it.
  CHECK(said<Accept>(bench.silence(FarmTime(1000))).size() == 1);
}

TEST_CASE("what a journal knows of a job of the sink is used, or done again if it is damaged") {
  for (const bool is_whole : {true, false}) {
    SinkBench bench(then_own(), {{key("own"), result_of(key("own"))}});
    bench.join(1);
    const SinkActions next = bench.accept(key("job 0"));
    CHECK(only<DoHere>(next).empty());
    const auto checks = only<Check>(next);
    REQUIRE(checks.size() == 1);
    CHECK(checks[0].what == Check::What::known);
    const JobFailure problem{is_whole ? "" : "damaged", FailureKind::attempt};
    const SinkActions then = bench.core.checked(checks[0], problem, bench.now);
    CHECK(only<DoHere>(then).size() == (is_whole ? 0 : 1));
    CHECK(only<MakeOutput>(then).empty());
    if (!is_whole) continue;
    CHECK(only<MakeOutput>(bench.verify(then)).size() == 1);
  }
}

TEST_CASE("a job of the sink that fails ends the run, one without room is done again") {
  SinkBench bench(then_own());
  bench.join(1);
  const auto to_do = only<DoHere>(bench.accept(key("job 0")));
  REQUIRE(to_do.size() == 1);
  bench.core.did(to_do[0], {}, {"disk full", true}, bench.now);
  CHECK(bench.core.waits_for_room());
  CHECK(only<DoHere>(bench.silence(FarmTime(1500))).size() == 1);
  const SinkActions failed = bench.core.did(to_do[0], {}, {"no memory", false}, bench.now);
  const auto said_so = said<Failed>(failed);
  REQUIRE(said_so.size() == 1);
  CHECK(said_so[0].reason == "no memory");
  CHECK_FALSE(said_so[0].resumable);
}

TEST_CASE("a job of the sink without room waits longer each time, whatever else is accepted") {
  Job own = make_job("own");
  own.by_sink = true;
  SinkBench bench(in_stages({{own, make_job("job 0"), make_job("job 1")}}));
  const auto to_do = only<DoHere>(bench.join(1));
  REQUIRE(to_do.size() == 1);
  const SinkProblem full{"ENOSPC", true};
  bench.core.did(to_do[0], {}, full, bench.now);
  for (const int pause : {1000, 2000}) {
    CHECK(only<DoHere>(bench.silence(FarmTime(pause - 1))).empty());
    CHECK(only<DoHere>(bench.silence(FarmTime(1))).size() == 1);
    CHECK(said<Accept>(bench.accept(key(pause == 1000 ? "job 0" : "job 1"))).size() == 1);
    CHECK(bench.core.waits_for_room());
    bench.core.on_control(Alive{1, {}}, bench.now);
    bench.core.did(to_do[0], {}, full, bench.now);
  }
  CHECK(only<DoHere>(bench.silence(FarmTime(3999))).empty());
  CHECK(only<DoHere>(bench.silence(FarmTime(1))).size() == 1);
  const SinkActions done = bench.core.did(to_do[0], result_of(key("own")), {}, bench.now);
  CHECK(only<Check>(done).size() == 1);
  CHECK_FALSE(bench.core.waits_for_room());
}

TEST_CASE("jobs that were given up end the run, and say whether it may be taken up again") {
  SinkBench bench(2);
  bench.join(1);
  const auto end_of = [&] {
    return only<SinkLeaves>(bench.core.on_control(Stop{StopReason::run_over}, bench.now)).at(0);
  };
  SUBCASE("their input is bad") {
    bench.core.on_control(JobFailed{key("job 0"), "no mesh", false}, bench.now);
    bench.core.on_control(JobFailed{key("job 1"), "lost workers", true}, bench.now);
    const SinkLeaves end = end_of();
    CHECK(end.why == SinkLeaves::Why::jobs_failed);
    CHECK(end.message.find("2 jobs failed for good") != std::string::npos);
  }
  SUBCASE("they cost workers their lives") {
    bench.core.on_control(JobFailed{key("job 0"), "lost workers", true}, bench.now);
    CHECK(end_of().why == SinkLeaves::Why::incomplete);
  }
  SUBCASE("a late result makes up for it") {
    bench.core.on_control(JobFailed{key("job 0"), "lost workers", false}, bench.now);
    bench.accept(key("job 0"));
    const SinkLeaves end = end_of();
    CHECK(end.why == SinkLeaves::Why::incomplete);
    CHECK(end.message.find("before its end") != std::string::npos);
  }
  SUBCASE("the whole run cannot go on") {
    bench.core.on_control(JobFailed{k_whole_run, "the stage is full", true}, bench.now);
    const SinkLeaves end = end_of();
    CHECK(end.why == SinkLeaves::Why::incomplete);
    CHECK(end.message == "the stage is full");
  }
}

TEST_CASE("a sink that is stopped, replaced or alone for too long leaves, resumable") {
  SinkBench bench(1);
  SUBCASE("stopped") {
    bench.join(1);
    CHECK(only<SinkLeaves>(bench.core.stop()).at(0).why == SinkLeaves::Why::incomplete);
  }
  SUBCASE("replaced") {
    bench.join(1);
    const SinkActions end = bench.core.on_control(Refused{Refusal::replaced, "another"}, bench.now);
    CHECK(only<SinkLeaves>(end).at(0).message.find("another") != std::string::npos);
  }
  SUBCASE("alone") {
    bench.core.tick(bench.now);
    const auto left = only<SinkLeaves>(bench.silence(FarmTime(10'001)));
    REQUIRE(left.size() == 1);
    CHECK(left[0].message.find("meshfarm run") != std::string::npos);
  }
}

}  // namespace
}  // namespace meshfarm::test
