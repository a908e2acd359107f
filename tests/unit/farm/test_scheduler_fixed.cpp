// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scheduler_desk.hpp"

namespace meshfarm::test {
namespace {

SchedulerOptions fixed_for(std::uint32_t workers) {
  return {.schedule = Schedule::fixed, .expect_workers = workers};
}

TEST_CASE("by a fixed schedule, too, the others go on once such a job's worker is lost") {
  ScheduleDesk desk({with_memory("large", 9, 800), with_memory("small", 8, 10)}, fixed_for(2));
  desk.join(1, "host", {0, 900, 1, 5});
  desk.join(2, "host", {0, 900, 1, 5});
  CHECK(desk.hand_out() == "large@1 ");
  CHECK(desk.hand_out().empty());
  for (const auto& held : desk.scheduler.leave({1})) desk.plan.give_back(held.key);
  CHECK(desk.hand_out() == "small@2 large@2 ");
}

TEST_CASE("a fixed schedule goes on when another run has done what fits nobody here") {
  ScheduleDesk desk(std::vector<Job>{}, fixed_for(1));
  const Job large = with_memory("large", 9, 1000);
  desk.plan = Plan(in_stages({{large}, {make_job("next")}}), 3);
  desk.plan.restart({});
  desk.join(1, "host", {0, 500, 1});
  CHECK(desk.hand_out().empty());
  desk.plan.accept(key_of(large), output_of(key_of(large)));
  CHECK(desk.hand_out() == "next@1 ");
}

TEST_CASE("by a fixed schedule, too, one suspect at a time is given to a worker") {
  ScheduleDesk desk({make_job("suspect", 9), make_job("other suspect", 8), make_job("job", 7)},
                    fixed_for(1));
  desk.scheduler.suspect(key_of(make_job("suspect")));
  desk.scheduler.suspect(key_of(make_job("other suspect")));
  desk.join(1, "a");
  CHECK(desk.hand_out() == "suspect@1 job@1 ");
  desk.done(1, "suspect");
  CHECK(desk.hand_out() == "other suspect@1 ");
}

TEST_CASE("by a fixed schedule, too, a job that failed on a host is tried on another") {
  ScheduleDesk desk({make_job("long", 9), make_job("job", 1)}, fixed_for(2));
  desk.join(1, "fast", {1'000'000, 0, 1});
  desk.join(2, "slow", {1, 0, 1});
  CHECK(desk.hand_out() == "long@1 job@1 ");
  desk.fail(1, "job");
  SUBCASE("if there is one") {
    CHECK(desk.hand_out() == "job@2 ");
  }
  SUBCASE("and else there again") {
    desk.scheduler.leave({2});
    CHECK(desk.hand_out() == "job@1 ");
  }
  SUBCASE("also where the other comes when it was dealt out again") {
    desk.scheduler.leave({2});
    desk.scheduler.set_room({1}, 0);
    CHECK(desk.hand_out().empty());
    desk.join(3, "other", {1, 0, 1});
    CHECK(desk.hand_out() == "job@3 ");
  }
}

TEST_CASE("by a fixed schedule a host that gets no more jobs keeps none from the others") {
  ScheduleDesk desk({make_job("a", 1), make_job("b", 1), make_job("c", 1), make_job("d", 1)},
                    fixed_for(2));
  desk.join(1, "good");
  desk.join(2, "bad", {}, 0);
  CHECK(desk.hand_out() == "a@1 c@1 ");
  for (int i = 0; i < 3; ++i) {
    desk.now += FarmTime(20'000);
    desk.scheduler.failed({2}, desk.now);
  }
  REQUIRE(desk.scheduler.bad_hosts().size() == 1);
  desk.scheduler.set_room({2}, 9);
  SUBCASE("what it was dealt goes to them") {
    CHECK(desk.hand_out() == "b@1 d@1 ");
  }
  SUBCASE("what fits it alone waits for the end of its ban") {
    desk.scheduler.leave({1});
    for (const std::string name : {"a", "c"}) desk.plan.give_back(key_of(make_job(name, 1)));
    desk.join(3, "good", {0, 1, 1});
    desk.plan = Plan(in_stages({{with_memory("large", 9, 1000)}}), 3);
    desk.plan.restart({});
    CHECK(desk.hand_out().empty());
    desk.now += FarmTime(301'000);
    CHECK(desk.hand_out() == "large@2 ");
  }
}

}  // namespace
}  // namespace meshfarm::test
