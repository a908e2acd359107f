// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/membership.hpp>

namespace meshfarm {
namespace {

Endpoint live(std::uint32_t epoch, std::uint64_t run) {
  return {epoch, run, "tcp://" + std::to_string(epoch), "h", 1, {}};
}
Endpoint over(std::uint32_t epoch, std::uint64_t run) {
  return {epoch, run, {}, "h", 1, {}};
}

/// A member that looks for a ventilator, with a clock.
struct Seeker {
  explicit Seeker(std::uint64_t run = 0)
      : member({Role::worker, run, 99, 1, "h", {}, FarmTime(30'000)}) {}

  /// The address that it dials once it sees these endpoints; empty: no new one.
  std::string sees(const std::vector<Endpoint>& endpoints) {
    now += FarmTime(500);
    last = member.tick(now);
    if (last == Membership::Event::none) last = member.found(endpoints, now);
    member.hello();
    return member.dial().value_or("");
  }
  void welcome(const Endpoint& from) {
    CHECK(member.on_message(Welcome{{1}, from.epoch, from.run, "lane", "", 1000}, now) ==
          Membership::Event::joined);
  }

  Membership member;
  Membership::Event last = Membership::Event::none;
  FarmTime now{0};
};

TEST_CASE("a run that ended does not hide one that lives") {
  Seeker seeker;
  CHECK(seeker.sees({live(1, 7), live(2, 8), over(3, 8)}) == "tcp://1");
}

TEST_CASE("who serves one run sees no other") {
  Seeker seeker(7);
  CHECK(seeker.sees({live(1, 8)}).empty());
  CHECK(seeker.sees({live(1, 8), live(2, 7), live(3, 8)}) == "tcp://2");
  CHECK(seeker.sees({live(1, 8), live(2, 7), live(3, 8), over(4, 8)}).empty());
  CHECK(seeker.last == Membership::Event::none);
  CHECK(seeker.sees({live(2, 7), over(5, 7)}).empty());
  CHECK(seeker.last == Membership::Event::run_over);
}

TEST_CASE("a ventilator that was killed does not hide one that lives") {
  Seeker seeker;
  const std::vector<Endpoint> both = {live(1, 7), live(2, 8)};
  CHECK(seeker.sees(both) == "tcp://2");
  std::string next;
  for (int i = 0; i < 20 && next.empty(); ++i) next = seeker.sees(both);
  CHECK(next == "tcp://1");
  SUBCASE("whichever it is") {
    next.clear();
    for (int i = 0; i < 20 && next.empty(); ++i) next = seeker.sees(both);
    CHECK(next == "tcp://2");
  }
  SUBCASE("and patience ends although there is always one more to try") {
    for (int i = 0; i < 100 && seeker.last == Membership::Event::none; ++i) seeker.sees(both);
    CHECK(seeker.last == Membership::Event::expired);
  }
  SUBCASE("one that turns out to be over is no reason to leave") {
    CHECK(seeker.sees({live(1, 7), live(2, 8), over(3, 8)}).empty());
    CHECK(seeker.last == Membership::Event::none);
    seeker.welcome(live(1, 7));
  }
}

TEST_CASE("who lost a ventilator stays with its run") {
  Seeker seeker;
  CHECK(seeker.sees({live(1, 7)}) == "tcp://1");
  seeker.welcome(live(1, 7));
  seeker.now += FarmTime(10'000);
  CHECK(seeker.member.tick(seeker.now) == Membership::Event::lost);
  CHECK(seeker.sees({live(1, 7), live(2, 8)}) == "tcp://1");
  CHECK(seeker.sees({live(1, 7), live(2, 8), over(3, 7)}).empty());
  CHECK(seeker.last == Membership::Event::run_over);
}

/// The times of the heartbeats of a member that joins at 0, in milliseconds.
std::vector<int> beats_of(std::uint64_t incarnation) {
  Membership member({Role::worker, 0, incarnation, 1, "h", {}, FarmTime(30'000)});
  const Endpoint endpoint = live(1, 7);
  member.found({&endpoint, 1}, FarmTime(0));
  member.on_message(Welcome{{1}, 1, 7, "lane", "", 1000}, FarmTime(0));
  std::vector<int> beats;
  for (int ms = 0; ms < 3000; ++ms) {
    if (member.beat_due(FarmTime(ms))) beats.push_back(ms);
  }
  return beats;
}

TEST_CASE("those that joined at the same time do not show it at the same time ever after") {
  constexpr std::uint64_t k_members = 1000;
  std::map<int, int> at;
  for (std::uint64_t i = 0; i < k_members; ++i) {
    const std::vector<int> beats = beats_of(i * 2'654'435'761);
    REQUIRE(beats.size() >= 3);
    CHECK(beats[0] == 0);
    CHECK(beats[1] <= 1000);
    CHECK(beats[2] == beats[1] + 1000);
    ++at[beats[2] / 100];
  }
  for (const auto& [when, members] : at) CHECK(members <= 150);
}

}  // namespace
}  // namespace meshfarm
