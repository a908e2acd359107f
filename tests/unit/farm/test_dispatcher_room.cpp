// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/farm/dispatcher.hpp>

#include "dispatcher_desk.hpp"

namespace meshfarm::test {
namespace {

Reject no_room(JobKey key, std::uint32_t attempt) {
  return {k_epoch, {1}, attempt, key, {"ENOSPC", FailureKind::no_space}};
}

TEST_CASE("a stage without room: nobody is blamed, and all wait for a probe that can be written") {
  Desk desk(one_stage(6));
  desk.sink("s", 9);
  desk.worker("w", 1);
  const auto sent = only<PushJob>(desk.credit("w", 1, 4));
  REQUIRE(sent.size() == 4);
  const Actions full = desk.say("s", no_room(sent[0].key, 1001));
  CHECK(only<Finish>(full).empty());
  CHECK(said_to<Done>("w", full).size() == 1);
  CHECK(desk.dispatcher.progress().no_room);
  desk.say("s", no_room(sent[1].key, 1001));
  CHECK(desk.dispatcher.progress().jobs_running == 2);
  CHECK(desk.dispatcher.plan().state(sent[0].key) == JobState::ready);
  CHECK(desk.dispatcher.progress().retries == 0);
  CHECK(only<PushJob>(desk.credit("w", 1, 9)).empty());
  CHECK(only<PushJob>(desk.accept("s", sent[2].key, 1)).empty());

  CHECK(only<ProbeStage>(desk.silence(FarmTime(500))).empty());
  const auto probes = only<ProbeStage>(desk.silence(FarmTime(600)));
  REQUIRE(probes.size() == 1);
  CHECK(probes[0].bytes >= 1000);
  CHECK(only<ProbeStage>(desk.silence(FarmTime(100))).empty());  // one at a time
  CHECK(only<PushJob>(desk.dispatcher.probed("still full", desk.now)).empty());
  CHECK(only<ProbeStage>(desk.silence(FarmTime(1000))).empty());
  desk.credit("w", 1, 9);
  desk.say("s", Ready{k_epoch, 1});
  CHECK(only<ProbeStage>(desk.silence(FarmTime(1000))).size() == 1);
  CHECK(only<PushJob>(desk.dispatcher.probed("", desk.now)).size() == 4);
  CHECK_FALSE(desk.dispatcher.progress().no_room);
}

TEST_CASE("a stage that is full again at once is asked for more room, later") {
  Desk desk(one_stage(2));
  desk.sink("s", 9);
  desk.worker("w", 1);
  const JobKey job = only<PushJob>(desk.credit("w", 1, 1)).at(0).key;
  desk.say("s", no_room(job, 1001));
  const auto first = only<ProbeStage>(desk.silence(FarmTime(1000)));
  REQUIRE(first.size() == 1);
  desk.credit("w", 1, 2);
  CHECK(only<PushJob>(desk.dispatcher.probed("", desk.now)).size() == 1);
  desk.say("s", no_room(job, 1002));
  CHECK(only<ProbeStage>(desk.silence(FarmTime(1500))).empty());
  const auto second = only<ProbeStage>(desk.silence(FarmTime(600)));
  REQUIRE(second.size() == 1);
  CHECK(second[0].bytes > first[0].bytes);
}

TEST_CASE("nothing is given out while the sink has no room") {
  Desk desk(one_stage(6));
  desk.sink("s", 9);
  desk.worker("w", 1);
  Heartbeat beat;
  beat.epoch = k_epoch;
  beat.no_room = true;
  desk.say("s", beat);
  CHECK(desk.dispatcher.progress().no_room);
  CHECK(only<PushJob>(desk.credit("w", 1, 4)).empty());
  beat.no_room = false;
  CHECK(only<PushJob>(desk.say("s", beat)).size() == 4);
  CHECK_FALSE(desk.dispatcher.progress().no_room);
}

TEST_CASE("a stage without room ends a run that shall not wait, resumable") {
  Desk desk(one_stage(2), WhenFull::end);
  desk.sink("s", 9);
  desk.worker("w", 1);
  desk.credit("w", 1, 1);
  // A late message of a worker, from an earlier run: room has been made since.
  const Actions late =
      desk.say("s", Reject{k_epoch, {1}, 7, key(1), {"ENOSPC", FailureKind::no_space}});
  CHECK(only<Finish>(late).empty());
  CHECK(said_to<Done>("w", late).size() == 1);
  const Actions full =
      desk.say("s", Reject{k_epoch, {1}, 1001, key(1), {"ENOSPC", FailureKind::no_space}});
  REQUIRE(only<Finish>(full).size() == 1);
  CHECK(only<Finish>(full)[0].resumable);
  REQUIRE(said_to<JobFailed>("s", full).size() == 1);
  CHECK(said_to<JobFailed>("s", full)[0].key == k_whole_run);
  CHECK(said_to<Stop>("w", full).size() == 1);
}

}  // namespace
}  // namespace meshfarm::test
