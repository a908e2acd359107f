// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A file that one reader cannot read is tried by another, before anyone's host is blamed.
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "dispatcher_desk.hpp"

namespace meshfarm::test {
namespace {

const FileRef k_file{"results/x", 5, 6};

/// The sink is on "host"; workers 1 and 2 have hosts of their own, and worker 1 has some jobs.
struct ReadingDesk : Desk {
  explicit ReadingDesk(const std::string& second_host = "host2") : Desk(one_stage(60)) {
    sink("s", 90);
    join("w1", 1, "host1");
    join("w2", 2, second_host);
    pushes = only<PushJob>(credit("w1", 1, 3));
    REQUIRE(pushes.size() == 3);
  }
  void join(const PeerId& peer, std::uint64_t incarnation, const std::string& host) {
    Hello hello{Role::worker, 0, incarnation, 1, host, {}};
    hello.capacity.threads = 3;
    const auto lanes = only<OpenLane>(say(peer, hello));
    dispatcher.lane_opened(lanes.at(0).worker, "lane");
  }
  /// Reports the i-th job as failed, 20 s after the last message: a separate incident.
  Actions reject(std::size_t i, FailureKind kind, const FileRef& file = {}) {
    const PushJob& push = pushes.at(i);
    wait();
    return say("s", Reject{k_epoch, {1}, push.assignment.attempt, push.key, {"why", kind}, file});
  }
  Actions tried(std::size_t i, bool whole) {
    const PushJob& push = pushes.at(i);
    return say("w2", TriedRead{k_epoch, {2}, push.key, push.assignment.attempt, whole});
  }
  void wait() {
    now += FarmTime(20'000);
    Heartbeat beat;
    beat.epoch = k_epoch;
    beat.received = 1000;
    say("s", beat);
    for (const std::uint32_t id : {1U, 2U}) {
      beat.worker = {id};
      say("w" + std::to_string(id), beat);
    }
  }
  std::vector<std::string> bad_hosts() const { return dispatcher.progress().bad_hosts; }

  std::vector<PushJob> pushes;
};

TEST_CASE("a worker of a third host is asked to read what the sink cannot") {
  ReadingDesk desk;
  const Actions asked = desk.reject(0, FailureKind::unread, k_file);
  const auto reads = said_to<TryRead>("w2", asked);
  REQUIRE(reads.size() == 1);
  CHECK(reads[0].file == k_file);
  CHECK(said_to<Done>("w1", asked).empty());  // the attempt is still open
  CHECK(said_to<TryRead>("w2", desk.reject(0, FailureKind::unread, k_file)).empty());  // once
}

TEST_CASE("a host is blamed for its results when another cannot read them either") {
  ReadingDesk desk;
  bool whole = false;
  SUBCASE("it cannot") {}
  SUBCASE("it can") {
    whole = true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    desk.reject(i, FailureKind::unread, k_file);
    CHECK(said_to<Done>("w1", desk.tried(i, whole)).size() == 1);
  }
  CHECK(desk.bad_hosts() ==
        (whole ? std::vector<std::string>{} : std::vector<std::string>{"host1"}));
}

TEST_CASE("what the sink sees damaged and another sees whole the sink tries again for a while") {
  ReadingDesk desk;
  desk.reject(0, FailureKind::attempt, k_file);
  CHECK(said_to<Done>("w1", desk.tried(0, true)).empty());
  SUBCASE("and then it is done again, and nobody is to blame") {
    for (int i = 0; i < 4; ++i) {
      CHECK(said_to<Done>("w1", desk.reject(0, FailureKind::attempt, k_file)).empty());
    }
    CHECK(said_to<Done>("w1", desk.reject(0, FailureKind::attempt, k_file)).size() == 1);
  }
  SUBCASE("unless it sees the file, too") {
    const Actions done = desk.accept("s", desk.pushes[0].key, 1);
    CHECK(said_to<Done>("w1", done).size() == 1);
  }
  CHECK(desk.bad_hosts().empty());
}

TEST_CASE("a second reader that leaves, or never answers, blames nobody") {
  ReadingDesk desk;
  for (std::size_t i = 0; i < 3; ++i) desk.reject(i, FailureKind::attempt, k_file);
  Actions then;
  SUBCASE("it leaves") {
    desk.say("w2", Release{k_epoch, {2}});
    then = desk.dispatcher.tick(desk.now);
  }
  SUBCASE("it is silent of this") {
    for (int i = 0; i < 7; ++i) {
      desk.wait();
      for (Action& each : desk.dispatcher.tick(desk.now)) then.push_back(std::move(each));
    }
  }
  CHECK(said_to<Done>("w1", then).size() == 3);
  CHECK(desk.bad_hosts().empty());
}

TEST_CASE("where nobody else could tell the sink is believed") {
  ReadingDesk desk("host");  // the second worker reads through the sink's own mount
  const Actions rejected = desk.reject(0, FailureKind::attempt, k_file);
  CHECK(said_to<TryRead>("w2", rejected).empty());
  CHECK(said_to<Done>("w1", rejected).size() == 1);
}

TEST_CASE("a host that cannot read what its jobs need is blamed once another host can") {
  ReadingDesk desk;
  std::uint32_t read_ms = 10;
  bool soon = true;
  SUBCASE("it can at once") {}
  SUBCASE("it can after a while: who knows when the first could have") {
    read_ms = 60'000;
  }
  SUBCASE("it can, but when it tried all may have been well again") {
    soon = false;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    desk.reject(i, FailureKind::no_input);
    CHECK(desk.bad_hosts().empty());
    if (!soon) desk.wait();
    if (!soon) desk.wait();
    Accept accept;
    accept.epoch = k_epoch;
    accept.worker = {2};
    accept.key = desk.pushes[i].key;
    accept.times.read_ms = read_ms;
    desk.say("s", accept);
  }
  CHECK(desk.bad_hosts().empty() == (!soon || read_ms > 10));
}

}  // namespace
}  // namespace meshfarm::test
