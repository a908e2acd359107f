// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/dispatcher.hpp>

#include "dispatcher_desk.hpp"

namespace meshfarm::test {
namespace {

TEST_CASE("no job goes out before a sink is ready, nor beyond the credit") {
  Desk desk(one_stage(10));
  desk.worker("w", 1);
  CHECK(names(desk.credit("w", 1, 2)).empty());
  CHECK(names(desk.sink("s", 9)) == "job 9@1 job 8@1 ");
  CHECK(names(desk.credit("w", 1, 2)).empty());  // the same again gives nothing more
  CHECK(names(desk.credit("w", 1, 1)).empty());  // nor does less
  CHECK(names(desk.credit("w", 1, 3)) == "job 7@1 ");
  CHECK(names(desk.accept("s", key(9), 1)).empty());  // done, but no credit for another job
  CHECK(desk.dispatcher.holding() == 2);
}

TEST_CASE("the worker that will be free first is served first") {
  Desk desk(one_stage(4));
  desk.worker("a", 1);
  desk.worker("b", 2);
  desk.credit("a", 1, 4);
  desk.credit("b", 2, 4);
  CHECK(names(desk.sink("s", 9)) == "job 3@1 job 2@2 job 1@2 job 0@1 ");
}

TEST_CASE("those who watch are told who came, what was done in which stage, and who left") {
  const JobSource source = in_stages({make_jobs(1), make_jobs(2)});
  DispatcherOptions options;
  options.run = k_run;
  options.epoch = k_epoch;
  options.tell = true;
  Desk desk(source);
  desk.dispatcher = Dispatcher(Plan(source, 3), options);
  const auto told = [](const Actions& actions) {
    const auto tells = only<Tell>(actions);
    REQUIRE(tells.size() == 1);
    return tells[0].event;
  };
  desk.sink("s", 9);
  const Actions hello = desk.say("w", Hello{Role::worker, 0, 1, 5, "host", {}, {7, 8, 2}});
  CHECK(std::get<WorkerJoined>(told(hello)).capacity.threads == 2);
  desk.dispatcher.lane_opened({1}, "lane");
  desk.credit("w", 1, 5);
  CHECK(std::get<JobAccepted>(told(desk.accept("s", key(0), 1))).place.stage == "stage 0");
  CHECK(only<Tell>(desk.accept("s", key(0), 1)).empty());  // it is known already
  const auto second = std::get<JobAccepted>(told(desk.accept("s", key(1), 1)));
  CHECK(second.place.stage == "stage 1");
  CHECK(second.place.index == 1);
  REQUIRE(second.place.needs.size() == 1);
  CHECK(second.place.needs[0].stage == "stage 0");
  CHECK(second.job.parameters == "job 1");
  CHECK(second.worker == WorkerId{1});
}

TEST_CASE("a silent worker loses its jobs; those it may have had in work are suspects") {
  Desk desk(one_stage(4));
  desk.sink("s", 9);
  desk.worker("a", 1);
  CHECK(names(desk.credit("a", 1, 3)) == "job 3@1 job 2@1 job 1@1 ");
  desk.silence(FarmTime(2000));
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  desk.worker("b", 2);
  const Actions lost = desk.silence(FarmTime(1001));
  REQUIRE(only<CloseLane>(lost).size() == 1);
  CHECK(only<CloseLane>(lost)[0].worker == WorkerId{1});
  CHECK(desk.dispatcher.progress().workers_lost == 1);
  CHECK(desk.dispatcher.holding() == 0);
  // Two were in work at most: one computed, one read ahead. They do not go out together again.
  const Actions first = desk.credit("b", 2, 2);
  const auto again = only<PushJob>(first);
  REQUIRE(again.size() == 2);
  CHECK(again[1].assignment.job.parameters == "job 1");
  CHECK(again[0].assignment.job.parameters == "job 3");
  CHECK(again[0].assignment.attempt == 1002);  // the second attempt of the second epoch

  SUBCASE("innocent ones are done one by one, then all goes on as before") {
    desk.accept("s", key(3), 2);
    CHECK(names(desk.credit("b", 2, 4)) == "job 2@2 job 0@2 ");
  }
  SUBCASE("its late result is taken, and the new holder told to stop") {
    const Actions done = desk.accept("s", key(3), 1);
    CHECK(said_to<Done>("b", done).size() == 1);
    CHECK(desk.dispatcher.plan().state(key(3)) == JobState::done);
  }
  SUBCASE("a late failure of its attempt is not held against the new one") {
    Reject late{k_epoch, {1}, 1001, key(3), {"late", FailureKind::attempt}};
    desk.say("s", late);
    CHECK(desk.dispatcher.plan().state(key(3)) == JobState::running);
  }
  SUBCASE("it is a stranger from now on, and must say hello") {
    const Actions answer = desk.say("a", Heartbeat{k_epoch, {1}, 0, 3, 0});
    REQUIRE(said_to<Refused>("a", answer).size() == 1);
    CHECK(said_to<Refused>("a", answer)[0].why == Refusal::stranger);
  }
}

/// A worker that takes the only job and falls silent, while the sink stays.
Actions worker_dies(Desk& desk, std::uint32_t worker) {
  const PeerId peer = "w" + std::to_string(worker);
  desk.worker(peer, worker);
  CHECK(names(desk.credit(peer, worker, 1)) == "job 0@" + std::to_string(worker) + " ");
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  desk.silence(FarmTime(1600));
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  return desk.silence(FarmTime(1600));
}

TEST_CASE("of the jobs in work when a worker is lost the one that was a suspect before is blamed") {
  Desk desk(one_stage(3));
  desk.sink("s", 9);
  desk.worker("a", 1);
  CHECK(names(desk.credit("a", 1, 2)) == "job 2@1 job 1@1 ");
  desk.silence(FarmTime(2000));
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  desk.worker("b", 2);
  desk.silence(FarmTime(1001));
  CHECK(names(desk.credit("b", 2, 2)) == "job 2@2 job 0@2 ");
  desk.silence(FarmTime(1900));
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  desk.silence(FarmTime(1200));
  CHECK(desk.dispatcher.plan().state(key(2)) == JobState::ready);
  for (const std::uint32_t id : {3, 4}) {
    const PeerId peer = "w" + std::to_string(id);
    desk.worker(peer, id);
    desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
    CHECK(names(desk.credit(peer, id, 1)) == "job 2@" + std::to_string(id) + " ");
    desk.silence(FarmTime(1900));
    desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
    desk.silence(FarmTime(1200));
  }
  CHECK(desk.dispatcher.plan().state(key(2)) == JobState::failed);
  CHECK(desk.dispatcher.plan().counts().failed == 1);
}

TEST_CASE("a job that three workers died of is given up") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  CHECK(only<Finish>(worker_dies(desk, 1)).empty());
  CHECK(only<Finish>(worker_dies(desk, 2)).empty());
  const Actions last = worker_dies(desk, 3);
  REQUIRE(only<Finish>(last).size() == 1);
  CHECK(only<Finish>(last)[0].failure.find("silent") != std::string::npos);
  CHECK(only<Finish>(last)[0].resumable);
  CHECK(said_to<JobFailed>("s", last).size() == 1);
  CHECK(said_to<Stop>("s", last).size() == 1);
}

TEST_CASE("a job is not blamed for a worker that comes back") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  worker_dies(desk, 1);
  worker_dies(desk, 2);
  desk.worker("w1 again", 1);
  CHECK(names(desk.credit("w1 again", 3, 1)) == "job 0@3 ");
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  desk.silence(FarmTime(1600));
  desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
  CHECK(only<Finish>(desk.silence(FarmTime(1600))).empty());
  CHECK(desk.dispatcher.plan().counts().failed == 0);
}

Heartbeat standing(std::uint32_t worker, JobKey job, std::uint32_t still_ms, bool in_storage) {
  Heartbeat beat{k_epoch, {worker}, 1, 1, 0};
  beat.still = job;
  beat.still_ms = still_ms;
  beat.in_storage = in_storage;
  return beat;
}

TEST_CASE("a job that stands still costs its worker its jobs") {
  Desk desk(one_stage(2));
  desk.sink("s", 9);
  desk.worker("a", 1);
  desk.worker("b", 2);
  desk.credit("a", 1, 1);
  desk.credit("b", 2, 2);
  SUBCASE("while it computes") {
    CHECK(said_to<Stop>("a", desk.say("a", standing(1, key(1), 29'999, false))).empty());
    const Actions lost = desk.say("a", standing(1, key(1), 30'000, false));
    REQUIRE(said_to<Stop>("a", lost).size() == 1);
    CHECK(said_to<Stop>("a", lost)[0].why == StopReason::hung);
    CHECK(only<CloseLane>(lost).size() == 1);
    CHECK(desk.dispatcher.progress().workers_lost == 1);
    CHECK(names(lost) == "job 1@2 ");  // a suspect now, but worker 2 holds no other suspect
  }
  SUBCASE("while it waits for the stage, much longer than others: its process lives on") {
    desk.say("b", standing(2, key(0), 0, true));
    const Actions waits = desk.say("a", standing(1, key(1), 119'999, true));
    CHECK(names(waits).empty());
    CHECK(said_to<Alive>("a", waits).size() == 1);
    const Actions lost = desk.say("a", standing(1, key(1), 120'000, true));
    CHECK(said_to<Stop>("a", lost).empty());
    REQUIRE(said_to<Refused>("a", lost).size() == 1);
    CHECK(said_to<Refused>("a", lost)[0].why == Refusal::stranger);
    CHECK(names(lost) == "job 1@2 ");  // not the job's fault
    CHECK(desk.dispatcher.progress().workers_lost == 0);
    CHECK(desk.dispatcher.progress().bad_hosts.empty());
  }
  SUBCASE("but not while most wait for the stage") {
    desk.say("b", standing(2, key(0), 20'000, true));
    const Actions waits = desk.say("a", standing(1, key(1), 90'000, true));
    CHECK(said_to<Stop>("a", waits).empty());
    CHECK(desk.dispatcher.progress().storage_stalls);
    CHECK(desk.dispatcher.holding() == 2);
  }
}

TEST_CASE("a job that takes long by its estimate may stand still longer") {
  const std::uint64_t hundred_seconds = 100'000'000;
  Desk desk(in_stages({{make_job("big", hundred_seconds)}}));
  desk.sink("s", 9);
  desk.worker("a", 1);
  desk.credit("a", 1, 1);
  const JobKey big = key_of(make_job("big"));
  CHECK(said_to<Stop>("a", desk.say("a", standing(1, big, 299'000, false))).empty());
  CHECK(said_to<Stop>("a", desk.say("a", standing(1, big, 301'000, false))).size() == 1);
}

TEST_CASE("jobs that are larger than every worker's memory end the run, resumable") {
  std::vector<Job> jobs = make_jobs(2);
  jobs[1].memory = std::uint64_t{800} << 20;
  Desk desk(in_stages({jobs}));
  desk.sink("s", 9);
  Hello small{Role::worker, 0, 1, 1, "host", {}};
  small.capacity.memory = std::uint64_t{300} << 20;
  desk.dispatcher.lane_opened(only<OpenLane>(desk.say("w", small))[0].worker, "lane");
  desk.credit("w", 1, 9);
  const auto live_on = [&] {
    desk.now += FarmTime(1000);
    desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
    desk.say("w", Heartbeat{k_epoch, {1}, 0, 1, 0});
    return only<Finish>(desk.dispatcher.tick(desk.now));
  };
  for (int i = 0; i < 100; ++i) CHECK(live_on().empty());  // something is still being done
  SUBCASE("once nothing else is left and no larger worker came") {
    desk.accept("s", key(0), 1);
  }
  SUBCASE("even if another failed for good") {
    desk.say("s", Reject{k_epoch, {1}, 1001, key(0), {"bad input", FailureKind::for_good}});
  }
  std::vector<Finish> end;
  for (int i = 0; i < 62 && end.empty(); ++i) {
    end = live_on();
    if (i < 58) CHECK(end.empty());
  }
  REQUIRE(end.size() == 1);
  CHECK(end[0].resumable);
  CHECK(end[0].failure.find("1 job needs more memory") != std::string::npos);
  CHECK(end[0].failure.find("--parts") != std::string::npos);
}

TEST_CASE("a sink that cannot read blames nobody, and the run may be taken up again") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  desk.worker("a", 1);
  desk.worker("b", 2);
  desk.credit("a", 1, 9);
  Actions last;
  for (std::uint32_t attempt = 1; attempt <= 3; ++attempt) {
    CHECK(desk.dispatcher.holding() == 1);
    last =
        desk.say("s", Reject{k_epoch, {1}, 1000 + attempt, key(0), {"EIO", FailureKind::unread}});
  }
  CHECK(desk.dispatcher.progress().bad_hosts.empty());
  REQUIRE(only<Finish>(last).size() == 1);
  CHECK(only<Finish>(last)[0].resumable);
}

TEST_CASE("very many failures are told in a time that grows with their number only") {
  constexpr int k_jobs = 20'000;
  Desk desk(one_stage(k_jobs));
  desk.sink("s", 9);
  desk.worker("w", 1);
  const auto start = std::chrono::steady_clock::now();
  for (const Job& job : make_jobs(k_jobs)) {
    const Reject bad{k_epoch, {1}, 1, key_of(job), {"bad input", FailureKind::for_good}};
    CHECK(said_to<JobFailed>("s", desk.say("s", bad)).size() == 1);
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

TEST_CASE("under full load jobs go out, and nobody is silent whose words are unread") {
  Desk desk(one_stage(2));
  desk.sink("s", 9);
  desk.worker("w", 1);
  desk.now += FarmTime(60'000);
  desk.dispatcher.tick(desk.now, Dispatcher::Inbox::unread);
  CHECK(desk.dispatcher.progress().workers == 1);
  CHECK(desk.dispatcher.progress().sink_present);
  desk.dispatcher.tick(desk.now);
  CHECK(desk.dispatcher.progress().workers == 0);
  CHECK_FALSE(desk.dispatcher.progress().sink_present);
}

TEST_CASE("a duplicate of a result changes nothing") {
  Desk desk(one_stage(2));
  desk.sink("s", 9);
  desk.worker("w", 1);
  desk.credit("w", 1, 1);
  desk.accept("s", key(1), 1);
  const Actions again = desk.accept("s", key(1), 1);
  CHECK(desk.dispatcher.plan().counts().done == 1);
  CHECK(said_to<Done>("w", again).size() == 1);  // it may have missed the first
}

TEST_CASE("a rejected result is made again; another worker's rejection is not ours") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  desk.worker("w", 1);
  desk.credit("w", 1, 5);
  const Actions again =
      desk.say("s", Reject{k_epoch, {1}, 1001, key(0), {"damaged", FailureKind::attempt}});
  REQUIRE(said_to<Done>("w", again).size() == 1);
  CHECK(said_to<Done>("w", again)[0].attempt == 1001);  // not the attempt that is handed out now
  CHECK(names(again) == "job 0@1 ");
  CHECK(names(desk.say("s", Reject{k_epoch, {5}, 1002, key(0), {"forged", FailureKind::attempt}}))
            .empty());
  const Actions bad =
      desk.say("s", Reject{k_epoch, {1}, 1002, key(0), {"no mesh", FailureKind::for_good}});
  CHECK(only<Finish>(bad).size() == 1);
}

TEST_CASE("a worker that leaves gives its jobs back without blame") {
  Desk desk(one_stage(2));
  desk.sink("s", 9);
  desk.worker("a", 1);
  desk.worker("b", 2);
  desk.credit("a", 1, 2);
  desk.credit("b", 2, 4);
  CHECK(desk.dispatcher.holding() == 2);
  const Actions left = desk.say("a", Release{k_epoch, {1}});
  CHECK(only<CloseLane>(left).size() == 1);
  CHECK(desk.dispatcher.holding() == 2);
  CHECK(desk.dispatcher.progress().workers_lost == 0);
}

TEST_CASE("a worker that joins again under another routing id has lost what it held") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  desk.worker("a", 1);
  desk.credit("a", 1, 1);
  CHECK(desk.dispatcher.holding() == 1);
  desk.worker("a2", 1);
  CHECK(desk.dispatcher.holding() == 0);
  CHECK(desk.dispatcher.progress().workers == 1);
  CHECK(names(desk.credit("a2", 2, 1)) == "job 0@2 ");
}

TEST_CASE("a worker that was not answered yet and greets from elsewhere is the same one") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  const Hello hello{Role::worker, 0, 1, 1, "host", {}};
  const auto greet_again = [&] {
    const Actions again = desk.say("a2", hello);
    CHECK(only<OpenLane>(again).empty());
    CHECK(only<CloseLane>(again).empty());
    return again;
  };
  SUBCASE("its lane is open") {
    desk.worker("a", 1);
    CHECK(said_to<Welcome>("a2", greet_again()).size() == 1);
  }
  SUBCASE("its lane is not open yet") {
    desk.say("a", hello);
    CHECK(said_to<Welcome>("a2", greet_again()).empty());
    const Actions opened = desk.dispatcher.lane_opened({1}, "lane");
    CHECK(said_to<Welcome>("a2", opened).size() == 1);
    CHECK(said_to<Welcome>("a", opened).empty());
  }
  CHECK(names(desk.credit("a", 1, 1)).empty());
  CHECK(names(desk.credit("a2", 1, 1)) == "job 0@1 ");
  // Once it has joined, its jobs belong to the name that it joined with.
  desk.say("a3", hello);
  CHECK(desk.dispatcher.holding() == 0);
}

TEST_CASE("a lane that lost a job is noticed") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  desk.worker("a", 1);
  desk.credit("a", 1, 1);
  for (int i = 0; i < 4; ++i) {
    desk.silence(FarmTime(1000));
    desk.say("s", Heartbeat{k_epoch, {}, 0, 0, 0});
    const Actions answer = desk.say("a", Heartbeat{k_epoch, {1}, 0, 0, 0});
    CHECK(said_to<Refused>("a", answer).size() == (i == 3 ? 1 : 0));
  }
  CHECK(desk.dispatcher.holding() == 0);
}

TEST_CASE("a sink that is lost stops the farm until one is back and has told what it has") {
  Desk desk(one_stage(3));
  desk.sink("s", 9);
  desk.worker("w", 1);
  desk.credit("w", 1, 2);
  desk.accept("s", key(2), 1);
  desk.silence(FarmTime(2000));
  desk.say("w", Heartbeat{k_epoch, {1}, 1, 2, 0});
  const Actions lost = desk.silence(FarmTime(1001));
  CHECK(said_to<SinkAt>("w", lost).at(0).results.empty());
  CHECK(names(desk.credit("w", 1, 3)).empty());

  SUBCASE("the same again") {
    CHECK(names(desk.sink("s2", 9, {key(2)})) == "job 0@1 ");
  }
  SUBCASE("another, and the first is not taken back") {
    const Actions joined = desk.say("s2", Hello{Role::sink, k_run, 10, 1, "host", "results of s2"});
    CHECK(said_to<SinkAt>("w", joined).at(0).results == "results of s2");
    const Actions old = desk.say("s", Hello{Role::sink, k_run, 9, 1, "host", "x"});
    CHECK(said_to<Refused>("s", old).at(0).why == Refusal::replaced);
  }
  SUBCASE("one that lost a result: the job is ready again") {
    CHECK(names(desk.sink("s2", 10)) == "job 2@1 ");
    CHECK(desk.dispatcher.plan().counts().done == 0);
  }
  SUBCASE("one of whose words some got lost must join again") {
    desk.say("s2", Hello{Role::sink, k_run, 10, 1, "host", "results of s2"});
    const Actions ready = desk.say("s2", Ready{k_epoch, 1});
    CHECK(said_to<Refused>("s2", ready).at(0).why == Refusal::stranger);
    CHECK(names(ready).empty());
  }
}

TEST_CASE("workers are not let go before the sink has verified what it accepted before") {
  Desk desk(one_stage(2));
  desk.worker("w", 5);
  desk.say("s", Hello{Role::sink, k_run, 9, 1, "host", "results of s"});
  const auto accept = [&](int job, std::uint64_t unverified) {
    return desk.say("s", Accept{k_epoch, {}, key(job), {}, {}, unverified});
  };
  accept(0, 2);
  accept(1, 2);
  CHECK(said_to<Stop>("w", desk.say("s", Ready{k_epoch, 2, 2})).empty());
  SUBCASE("all is whole") {
    CHECK(said_to<Stop>("w", desk.say("s", Ready{k_epoch, 2, 1})).empty());
    CHECK(said_to<Stop>("w", desk.say("s", Ready{k_epoch, 2, 0})).size() == 1);
  }
  SUBCASE("one is taken back: the sink says hello anew") {
    desk.credit("w", 1, 3);
    desk.say("s2", Hello{Role::sink, k_run, 9, 1, "host", "results of s"});
    desk.say("s2", Accept{k_epoch, {}, key(0), {}, {}, 0});
    CHECK(names(desk.say("s2", Ready{k_epoch, 1, 0})) == "job 1@1 ");
    CHECK(said_to<Stop>("w", desk.accept("s2", key(1), 1)).size() == 1);
  }
  SUBCASE("the sink is lost, and a worker leaves: another sink may find damage") {
    desk.worker("w2", 6);
    desk.silence(FarmTime(2000));
    for (const char* peer : {"w", "w2"})
      desk.say(peer, Heartbeat{k_epoch, {peer[1] == 0 ? 1U : 2U}});
    desk.silence(FarmTime(1001));
    CHECK(said_to<Stop>("w", desk.say("w2", Release{k_epoch, {2}})).empty());
  }
}

TEST_CASE("a process of another build is refused, and both versions are named") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  for (const Role role : {Role::worker, Role::sink}) {
    Hello hello{role, k_run, 5, 1, "pc7", {}};
    hello.algorithm = 3;
    const auto refused = said_to<Refused>("w", desk.say("w", hello));
    REQUIRE(refused.size() == 1);
    CHECK(refused[0].why == Refusal::other_build);
    CHECK(refused[0].reason.find("version 0 of the algorithm") != std::string::npos);
    CHECK(refused[0].reason.find("by version 3") != std::string::npos);
  }
  CHECK(desk.dispatcher.progress().workers == 0);
  CHECK(desk.dispatcher.progress().other_build.find("pc7") != std::string::npos);
}

TEST_CASE("a worker that does not receive what was sent is asked to join anew") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  desk.worker("a", 1);
  CHECK(names(desk.credit("a", 1, 1)) == "job 0@1 ");
  const Heartbeat without{k_epoch, {1}, 0, 0, 0};
  SUBCASE("not because of what it said before, and is read late") {
    desk.now += FarmTime(20'000);
    for (int i = 0; i < 3; ++i) CHECK(said_to<Alive>("a", desk.say("a", without)).size() == 1);
    CHECK(said_to<Alive>("a", desk.say("a", Heartbeat{k_epoch, {1}, 1, 1, 0})).size() == 1);
    CHECK(said_to<Alive>("a", desk.say("a", without)).size() == 1);
    CHECK(desk.dispatcher.plan().state(key(0)) == JobState::running);
  }
  SUBCASE("if it says so again and again") {
    for (int i = 0; i < 3; ++i) {
      desk.now += FarmTime(1000);
      CHECK(said_to<Alive>("a", desk.say("a", without)).size() == 1);
    }
    desk.now += FarmTime(1000);
    const Actions lost = desk.say("a", without);
    REQUIRE(said_to<Refused>("a", lost).size() == 1);
    CHECK(said_to<Refused>("a", lost)[0].why == Refusal::stranger);
    CHECK(desk.dispatcher.plan().state(key(0)) == JobState::ready);
  }
}

TEST_CASE("the words of another epoch or of a stranger are dropped") {
  Desk desk(one_stage(2));
  desk.sink("s", 9);
  desk.worker("w", 1);
  const auto before = desk.dispatcher.dropped();
  CHECK(names(desk.say("w", Credit{k_epoch - 1, {1}, 5})).empty());
  CHECK(names(desk.say("x", Credit{k_epoch, {1}, 5})).empty());
  CHECK(names(desk.say("w", Credit{k_epoch, {2}, 5})).empty());
  CHECK(desk.say("x", Complete{k_epoch}).empty());
  CHECK(desk.say("s", Complete{k_epoch - 1}).empty());
  CHECK(desk.say("x", Stop{}).empty());
  CHECK(desk.dispatcher.dropped() == before + 6);
}

TEST_CASE("the end: workers hear it once all is accepted, the sink once it is complete") {
  Desk desk(one_stage(1));
  desk.sink("s", 9);
  desk.worker("w", 1);
  desk.credit("w", 1, 1);
  CHECK(only<Finish>(desk.say("s", Complete{k_epoch})).empty());  // too early
  const Actions all = desk.accept("s", key(0), 1);
  CHECK(said_to<Stop>("w", all).size() == 1);
  CHECK(said_to<Stop>("s", all).empty());
  const Actions late = desk.say("v", Hello{Role::worker, 0, 5, 1, "host", {}});
  CHECK(said_to<Stop>("v", late).size() == 1);
  const Actions end = desk.say("s", Complete{k_epoch});
  CHECK(said_to<Stop>("s", end).size() == 1);
  CHECK(only<Finish>(end).at(0).failure.empty());
}

}  // namespace
}  // namespace meshfarm::test
