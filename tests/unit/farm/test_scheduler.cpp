// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <map>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scheduler_desk.hpp"

namespace meshfarm::test {
namespace {

/// Workers that do exactly what they are told, in virtual time; each holds up to 16 jobs.
class Shop {
 public:
  Shop(std::vector<Job> jobs, const SchedulerOptions& options)
      : plan_(in_stages({std::move(jobs)}), 3), scheduler_(options) {
    plan_.restart({});
  }

  /// `speed`: its real speed; `claimed`: its benchmark.
  void add(double speed, double claimed) {
    const WorkerId id{static_cast<std::uint32_t>(speeds_.size() + 1)};
    speeds_[id] = speed;
    power_ += speed;
    scheduler_.join(id, "host " + std::to_string(id.value),
                    {static_cast<std::uint64_t>(claimed), 0, 1});
    scheduler_.set_room(id, k_room);
  }

  /// The time until all jobs are done, relative to that of perfectly divisible work.
  double run() {
    double work = 0;
    for (const JobKey key : plan_.ready_jobs()) work += static_cast<double>(plan_.job(key).cost);
    const double ideal = 1000 * work / power_;
    for (; !plan_.complete(); now_ += FarmTime(1)) {
      REQUIRE(now_.count() < 100 * ideal + 10'000);
      for (const auto& [id, end] : std::map(ends_)) {
        if (end <= static_cast<double>(now_.count())) finish(id);
      }
      while (auto pick = scheduler_.next(plan_, now_)) begin(pick->worker);
      for (const auto& pick : scheduler_.second_attempts(plan_, now_)) begin(pick.worker);
    }
    return static_cast<double>(now_.count() - 1) / ideal;
  }

 private:
  static constexpr std::uint64_t k_room = 16;

  void begin(WorkerId id) {
    if (ends_.contains(id) || scheduler_.held(id).empty()) return;
    const auto& job = scheduler_.held(id).front();
    ends_[id] =
        static_cast<double>(now_.count()) + 1000 * static_cast<double>(job.cost) / speeds_.at(id);
    doing_[id] = job.key;
  }
  void finish(WorkerId id) {
    if (!ends_.contains(id)) return;
    const JobKey key = doing_.at(id);
    scheduler_.did(id, key, 0, now_);
    plan_.accept(key, output_of(key));
    for (const WorkerId holder : scheduler_.holders(key)) {
      scheduler_.drop(holder, key, now_);
      if (doing_[holder] == key) ends_.erase(holder);
      scheduler_.set_room(holder, k_room - scheduler_.held(holder).size());
      begin(holder);
    }
  }

  Plan plan_;
  Scheduler scheduler_;
  FarmTime now_{0};
  std::map<WorkerId, double> speeds_;
  std::map<WorkerId, double> ends_;
  std::map<WorkerId, JobKey> doing_;
  double power_ = 0;
};

/// A model of `triangles` cut into parts whose sizes vary like a partitioner's.
std::vector<Job> parts_of(double triangles, std::size_t parts, double spread, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < parts; ++i) {
    const double dice = static_cast<double>(random()) / 4294967296.0;
    const double size = triangles / static_cast<double>(parts) * (1 + spread * (2 * dice - 1));
    jobs.push_back(make_job("part " + std::to_string(i), static_cast<std::uint64_t>(size)));
  }
  return jobs;
}

/// 16 fast workers and 8 with a third of their speed: the paper's Figure 4.
double mixed_farm(std::size_t parts, const SchedulerOptions& options, double claim_of_slow = 1) {
  Shop shop(parts_of(1e9, parts, 0.1, 7), options);
  for (int i = 0; i < 16; ++i) shop.add(1e6, 1e6);
  for (int i = 0; i < 8; ++i) shop.add(1e6 / 3, claim_of_slow * 1e6 / 3);
  return shop.run();
}

TEST_CASE("16 fast and 8 slow workers end together, from 512 parts on within 3 %") {
  for (const std::size_t parts : {512, 1024, 2048, 4096}) {
    CAPTURE(parts);
    const double over = mixed_farm(parts, {});
    const double fixed = mixed_farm(parts, {.schedule = Schedule::fixed, .expect_workers = 24});
    MESSAGE(parts, " parts: dynamic ", over, ", fixed ", fixed, " of the ideal time");
    CHECK(over <= 1.03);
  }
  CHECK(mixed_farm(128, {}) <= 1.15);
}

TEST_CASE("a benchmark that is wrong by two is made up for by what workers do") {
  CHECK(mixed_farm(512, {}, 2.0) <= 1.05);
  CHECK(mixed_farm(512, {}, 0.5) <= 1.05);
  const SchedulerOptions fixed{.schedule = Schedule::fixed, .expect_workers = 24};
  CHECK(mixed_farm(512, fixed, 2.0) > 1.2);  // the fixed schedule does not adapt
}

TEST_CASE("24 equal workers are busy to the end") {
  for (const std::size_t parts : {96, 384}) {
    CAPTURE(parts);
    Shop shop(parts_of(1e9, parts, 0.2, 3), {});
    for (int i = 0; i < 24; ++i) shop.add(1e6, 1e6);
    CHECK(shop.run() <= (parts == 96 ? 1.06 : 1.02));
  }
}

TEST_CASE("a fixed schedule without surprises is close to the ideal, too") {
  CHECK(mixed_farm(512, {.schedule = Schedule::fixed, .expect_workers = 24}) <= 1.03);
}

TEST_CASE("a job is never given to a worker that it does not fit") {
  ScheduleDesk desk({with_memory("big", 9, 1000), with_memory("small", 1, 10)});
  desk.join(1, "a", {0, 500, 1});
  CHECK(desk.hand_out() == "small@1 ");
  CHECK(desk.plan.ready_above(*desk.scheduler.greatest_memory()) == 1);
  desk.join(2, "b", {0, 1000, 1});
  CHECK(desk.plan.ready_above(*desk.scheduler.greatest_memory()) == 0);
  desk.now += FarmTime(1000);
  CHECK(desk.hand_out() == "big@2 ");
}

TEST_CASE("workers of one host share its memory") {
  // Three processes that each found the same 900 bytes free.
  ScheduleDesk desk({with_memory("a", 9, 300), with_memory("b", 8, 300), with_memory("c", 7, 300)});
  desk.join(1, "host", {0, 900, 1, 5}, 1);
  CHECK(desk.scheduler.memory_share({1}) == 900);
  desk.join(2, "host", {0, 900, 1, 5}, 1);
  desk.join(3, "host", {0, 900, 1, 5}, 1);
  CHECK(desk.scheduler.memory_share({1}) == 300);
  SUBCASE("what fits a share goes to each") {
    CHECK(desk.hand_out() == "a@1 b@2 c@3 ");
    desk.scheduler.leave({3});
    CHECK(desk.scheduler.memory_share({1}) == 450);
  }
  SUBCASE("other pools, other hosts and memory of one's own are not divided") {
    desk.join(4, "host", {0, 900, 1, 6});
    desk.join(5, "other host", {0, 900, 1, 5});
    desk.join(6, "host", {0, 900, 1});
    for (const std::uint32_t id : {4, 5, 6}) CHECK(desk.scheduler.memory_share({id}) == 900);
    CHECK(desk.scheduler.memory_share({1}) == 300);
  }
}

TEST_CASE("a job larger than a share of its host's memory is done while the others rest") {
  ScheduleDesk desk({with_memory("large", 9, 800), with_memory("small", 8, 10)});
  desk.join(1, "host", {0, 900, 1, 5}, 1);
  desk.join(2, "host", {0, 900, 1, 5}, 1);
  CHECK(desk.hand_out() == "large@1 ");
  CHECK(desk.scheduler.memory_share({1}) == 900);
  desk.now += FarmTime(10'000);
  CHECK(desk.hand_out().empty());
  SUBCASE("until it is done") {
    desk.done(1, "large");
    desk.now += FarmTime(10'000);
    CHECK(desk.hand_out() == "small@2 ");
  }
  SUBCASE("or its worker is lost") {
    desk.scheduler.leave({1});
    desk.now += FarmTime(10'000);
    CHECK(desk.hand_out() == "small@2 ");
  }
}

TEST_CASE("a host that did a job is sent jobs again at once") {
  ScheduleDesk desk(
      {make_job("one", 1), make_job("two", 1), make_job("three", 1), make_job("four", 1)});
  desk.join(1, "good", {}, 0);
  desk.join(2, "bad", {}, 1);
  REQUIRE(desk.hand_out() == "one@2 ");
  for (int i = 0; i < 3; ++i) {
    desk.now += FarmTime(20'000);
    desk.scheduler.failed({2}, desk.now);
  }
  CHECK(desk.scheduler.bad_hosts().size() == 1);
  desk.scheduler.set_room({2}, 1);
  CHECK(desk.hand_out().empty());
  desk.scheduler.did({2}, key_of(make_job("one", 1)), 1, desk.now);
  CHECK(desk.scheduler.bad_hosts().empty());
  CHECK(desk.hand_out() == "two@2 ");
}

TEST_CASE("a job larger than a share waits for the others of the host") {
  ScheduleDesk desk({with_memory("small", 9, 10), with_memory("large", 8, 800)});
  desk.join(1, "host", {0, 900, 1, 5}, 1);
  desk.join(2, "host", {0, 900, 1, 5}, 1);
  CHECK(desk.hand_out() == "small@1 ");
  desk.done(1, "small");
  desk.now += FarmTime(10'000);
  CHECK(desk.hand_out() == "large@2 ");
}

TEST_CASE("a small worker finds what fits it behind very many that do not") {
  std::vector<Job> jobs = {with_memory("small", 1, 10)};
  for (int i = 0; i < 1000; ++i) {
    jobs.push_back(with_memory("big " + std::to_string(i), 1000, 1000));
  }
  ScheduleDesk desk(jobs);
  desk.join(1, "a", {0, 500, 1});
  CHECK(desk.hand_out() == "small@1 ");
}

TEST_CASE("the last job is left to a fast worker that comes free in time") {
  // "long" takes the fast worker 1 s, "last" 0.9 s; the slow one would need 9 s.
  ScheduleDesk desk({make_job("long", 1'000'000), make_job("last", 900'000)});
  desk.join(1, "fast", {1'000'000, 0, 1}, 1);
  desk.join(2, "slow", {100'000, 0, 1}, 1);
  CHECK(desk.hand_out() == "long@1 ");
  desk.now += FarmTime(999);
  CHECK(desk.hand_out().empty());
  SUBCASE("which it does") {
    desk.done(1, "long");
    desk.scheduler.set_room({1}, 1);
    CHECK(desk.hand_out() == "last@1 ");
  }
  SUBCASE("or does not: the slow one helps out") {
    desk.now += FarmTime(10'000);
    CHECK(desk.hand_out() == "last@2 ");
  }
}

TEST_CASE("an idle worker makes a second attempt at what would take another longer, once") {
  ScheduleDesk desk({make_job("long", 1'000'000)});
  desk.join(1, "slow", {100'000, 0, 1});
  CHECK(desk.hand_out() == "long@1 ");
  desk.join(2, "as slow", {100'000, 0, 1});
  CHECK(desk.second_attempts().empty());
  desk.join(3, "fast", {1'000'000, 0, 1});
  desk.join(4, "fast", {1'000'000, 0, 1});
  CHECK(desk.second_attempts() == "long@3 ");
  CHECK(desk.second_attempts().empty());  // two attempts at most
  CHECK(desk.scheduler.holders(key_of(make_job("long"))).size() == 2);
  CHECK(desk.plan.attempts(key_of(make_job("long"))) == 2);
  CHECK(desk.plan.counts().running == 1);
}

TEST_CASE("a straggler is overtaken once it is half as late again as it should be") {
  ScheduleDesk desk({make_job("long", 1'000'000)});
  desk.join(1, "a", {1'000'000, 0, 1});
  desk.join(2, "b", {1'000'000, 0, 1});
  CHECK(desk.hand_out() == "long@1 ");
  desk.now = FarmTime(1300);
  CHECK(desk.second_attempts().empty());
  desk.now = FarmTime(1500);
  CHECK(desk.second_attempts() == "long@2 ");
}

TEST_CASE("a worker of the same host helps only where the first attempt may be stuck") {
  ScheduleDesk desk({make_job("long", 1'000'000)});
  desk.join(1, "host", {1'000'000, 0, 1});
  desk.join(2, "host", {1'000'000, 0, 1});
  CHECK(desk.hand_out() == "long@1 ");
  desk.now = FarmTime(5'000);
  CHECK(desk.second_attempts().empty());
  SUBCASE("a slower one of another host need not wait for that") {
    desk.join(3, "other", {900'000, 0, 1});
    desk.now = FarmTime(6'000);
    CHECK(desk.second_attempts() == "long@3 ");
  }
  SUBCASE("after ten seconds more than it should take") {
    desk.now = FarmTime(11'200);
    CHECK(desk.second_attempts() == "long@2 ");
  }
}

TEST_CASE("what only waits is done by another worker of the same host") {
  std::vector<Job> jobs;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"}) {
    jobs.push_back(make_job(name, 500'000));
  }
  ScheduleDesk desk(jobs);
  desk.join(1, "host", {1'000'000, 0, 1});
  CHECK(desk.hand_out() == "a@1 b@1 c@1 ");
  desk.join(2, "host", {1'000'000, 0, 1});
  CHECK(desk.second_attempts() == "c@2 ");
}

TEST_CASE("where all jobs of a kind take longer, a second attempt would, too") {
  std::vector<Job> jobs;
  for (const char* name : {"a", "b", "c", "d"}) jobs.push_back(make_job(name, 1'000'000));
  ScheduleDesk desk(jobs);
  for (std::uint32_t id = 1; id <= 5; ++id) {
    desk.join(id, "host " + std::to_string(id), {1'000'000, 0, 1}, 1);
  }
  CHECK(desk.hand_out() == "a@1 b@2 c@3 d@4 ");
  desk.now = FarmTime(5'000);
  CHECK(desk.second_attempts().empty());
  SUBCASE("but not what takes longer than the others did") {
    for (const char* name : {"a", "b", "c"}) {
      desk.done(static_cast<std::uint32_t>(name[0] - 'a' + 1), name);
    }
    desk.now = FarmTime(6'000);
    CHECK(desk.second_attempts().empty());
    desk.now = FarmTime(9'000);
    CHECK(desk.second_attempts() == "d@5 ");
  }
  SUBCASE("nor is that believed for long") {
    desk.now = FarmTime(12'000);
    CHECK(desk.second_attempts().empty());
    desk.now = FarmTime(18'000);
    CHECK(desk.second_attempts() == "a@5 ");
  }
}

TEST_CASE("a job that failed on a host is tried on another") {
  ScheduleDesk desk({make_job("job")});
  desk.join(1, "a", {}, 1);
  CHECK(desk.hand_out() == "job@1 ");
  desk.fail(1, "job");
  SUBCASE("if there is one") {
    desk.join(2, "b", {}, 1);
    CHECK(desk.hand_out() == "job@2 ");
  }
  SUBCASE("and else there again") {
    CHECK(desk.hand_out() == "job@1 ");
  }
}

TEST_CASE("a job that failed where alone it fits is tried there again") {
  ScheduleDesk desk({with_memory("large", 9, 800)});
  desk.join(1, "large host", {0, 900, 1}, 1);
  desk.join(2, "small host", {0, 500, 1}, 1);
  CHECK(desk.hand_out() == "large@1 ");
  desk.fail(1, "large");
  CHECK(desk.hand_out() == "large@1 ");
}

TEST_CASE("jobs that fail on a host at the same time are one incident") {
  std::vector<Job> jobs;
  for (int i = 0; i < 16; ++i) jobs.push_back(make_job(std::to_string(i)));
  ScheduleDesk desk(jobs);
  desk.join(1, "a", {0, 0, 16}, 16);
  desk.join(2, "other", {}, 0);
  desk.hand_out();
  for (int i = 0; i < 16; ++i) desk.fail(1, std::to_string(i));
  CHECK(desk.scheduler.bad_hosts().empty());
}

TEST_CASE("a host where three jobs in a row failed gets no more, as long as there are others") {
  ScheduleDesk desk({make_job("x", 9), make_job("y", 8), make_job("z", 7), make_job("w", 6)});
  desk.join(1, "bad", {}, 1);
  desk.join(2, "good", {}, 0);
  for (const std::string name : {"x", "y", "z"}) {
    desk.now += FarmTime(10'000);
    CHECK(desk.hand_out() == name + "@1 ");
    desk.fail(1, name);
  }
  CHECK(desk.hand_out().empty());
  CHECK(desk.scheduler.bad_hosts() == std::vector<std::string>{"bad"});
  SUBCASE("until some minutes later") {
    desk.now += FarmTime(299'000);
    CHECK(desk.hand_out().empty());
    desk.now += FarmTime(2'000);
    CHECK(desk.hand_out() == "w@1 ");
    CHECK(desk.scheduler.bad_hosts().empty());
    desk.fail(1, "w");
    CHECK(desk.scheduler.bad_hosts() == std::vector<std::string>{"bad"});
  }
  SUBCASE("the others do the rest") {
    desk.scheduler.set_room({2}, 9);
    CHECK(desk.hand_out() == "x@2 y@2 ");  // one to do, one to read ahead
  }
  SUBCASE("no others are left") {
    desk.scheduler.leave({2});
    CHECK(desk.scheduler.bad_hosts().empty());
    CHECK(desk.hand_out() == "x@1 ");
  }
}

Job of_extent(const std::string& name, std::uint64_t extent) {
  Job job = make_job(name, 100'000);
  job.extent = {extent, 1};
  return job;
}

/// Two stages that read the same extents.
std::vector<std::vector<Job>> two_readings(std::uint32_t extents) {
  std::vector<std::vector<Job>> stages(2);
  for (std::uint32_t i = 0; i < extents; ++i) {
    stages[0].push_back(of_extent("first" + std::to_string(i), 1 + i));
    stages[1].push_back(of_extent("then" + std::to_string(extents - 1 - i), extents - i));
  }
  return stages;
}

TEST_CASE("what a host has read is read there again, by any of its workers") {
  ScheduleDesk desk(two_readings(4));
  for (const std::uint32_t id : {1, 2}) desk.join(id, "one", {1'000'000}, 1);
  for (const std::uint32_t id : {3, 4}) desk.join(id, "other", {1'000'000}, 1);
  CHECK(desk.hand_out() == "first0@1 first1@2 first2@3 first3@4 ");
  for (std::uint32_t i = 0; i < 4; ++i) desk.done(i + 1, "first" + std::to_string(i));
  for (const std::uint32_t id : {2, 4}) desk.scheduler.set_room({id}, 1);
  CHECK(desk.hand_out() == "then1@2 then3@4 ");
  desk.scheduler.set_room({1}, 1);
  CHECK(desk.hand_out() == "then0@1 ");
  desk.done(2, "then1");
  desk.scheduler.set_room({2}, 1);  // it does not wait for the other host
  CHECK(desk.hand_out() == "then2@2 ");
}

TEST_CASE("of idle workers the one gets a job whose host has read what it reads") {
  ScheduleDesk desk({{of_extent("first", 1), of_extent("other", 2)}, {of_extent("then", 2)}});
  for (const std::uint32_t id : {1, 2}) desk.join(id, std::to_string(id), {1'000'000}, 1);
  CHECK(desk.hand_out() == "first@1 other@2 ");
  desk.done(1, "first");
  desk.done(2, "other");
  desk.scheduler.set_room({1}, 1);
  SUBCASE("where it may take one") {
    desk.scheduler.set_room({2}, 1);
    CHECK(desk.hand_out() == "then@2 ");
  }
  SUBCASE("and is about as fast") {
    desk.scheduler.leave({2});
    desk.join(3, "2", {100'000}, 1);
    CHECK(desk.hand_out() == "then@1 ");
  }
  SUBCASE("but nobody waits for it") {
    CHECK(desk.hand_out() == "then@1 ");
  }
  SUBCASE("nor for one that had no luck with it") {
    desk.scheduler.set_room({2}, 1);
    desk.scheduler.avoid({2}, key_of(of_extent("then", 2)));
    CHECK(desk.hand_out() == "then@1 ");
  }
}

TEST_CASE("how fast a worker is shows beside what others take for jobs of its kinds") {
  const Job quick = make_job("quick", 100'000);
  Job heavy = make_job("heavy", 100'000);
  heavy.kind = "heavy";
  ScheduleDesk desk({{quick, heavy}, {make_job("last")}});
  for (const std::uint32_t id : {1, 2}) desk.join(id, "host", {1'000'000}, 1);
  CHECK(desk.hand_out() == "quick@1 heavy@2 ");
  desk.scheduler.did({1}, key_of(quick), 10, desk.now);
  desk.scheduler.did({2}, key_of(heavy), 1000, desk.now);
  for (const Job& job : {quick, heavy}) desk.plan.accept(key_of(job), output_of(key_of(job)));
  desk.now += FarmTime(1001);
  CHECK(desk.hand_out().empty());  // they have no room, but their speeds were updated
  CHECK(desk.scheduler.speed({1}) == doctest::Approx(desk.scheduler.speed({2})).epsilon(0.01));
}

TEST_CASE("one that takes longer at each kind is slower, and a wrong benchmark is its own only") {
  constexpr int k_jobs = 400;
  std::vector<Job> jobs;
  for (int i = 0; i < k_jobs; ++i) {
    jobs.push_back(make_job(std::to_string(i), 100'000));
    if (i % 2 != 0) jobs.back().kind = "heavy";
  }
  ScheduleDesk desk(jobs);
  // The third worker's benchmark claims a hundredth of its speed.
  for (const std::uint32_t id : {1, 2, 3}) {
    desk.join(id, "host", {id == 3 ? 10'000U : 1'000'000U}, 1);
  }
  for (int i = 0; i + 1 < k_jobs; ++i) {
    const auto pick = desk.scheduler.next(desk.plan, desk.now);
    REQUIRE(pick);
    const std::uint32_t times = pick->worker.value == 2 ? 2 : 1;
    const std::uint32_t ms = times * (pick->job.job.kind == "heavy" ? 300 : 100);
    desk.scheduler.did(pick->worker, pick->job.key, ms, desk.now);
    desk.scheduler.drop(pick->worker, pick->job.key, desk.now);
    desk.plan.accept(pick->job.key, output_of(pick->job.key));
    // They take turns, the third one rarely.
    desk.scheduler.set_room(pick->worker, 0);
    desk.scheduler.set_room({i % 8 == 0 ? 3U : 1U + static_cast<std::uint32_t>(i / 2 % 2)}, 1);
    desk.now += FarmTime(1001);
  }
  CHECK_FALSE(desk.hand_out().empty());
  const double first = desk.scheduler.speed({1});
  CHECK(first == doctest::Approx(500'000).epsilon(0.3));
  CHECK(first / desk.scheduler.speed({2}) == doctest::Approx(2).epsilon(0.2));
}

TEST_CASE("where a host has left, another is at home with what it had read") {
  ScheduleDesk desk({{of_extent("first", 5)},
                     {make_job("longer", 110'000), of_extent("then", 5), of_extent("last", 5)}});
  desk.join(1, "one", {1'000'000}, 1);
  desk.join(2, "other", {1'000'000}, 0);
  CHECK(desk.hand_out() == "first@1 ");
  desk.done(1, "first");
  SUBCASE("it is there") {
    desk.scheduler.set_room({1}, 1);
    CHECK(desk.hand_out() == "then@1 ");
  }
  SUBCASE("another is there") {
    desk.scheduler.set_room({2}, 1);
    CHECK(desk.hand_out() == "longer@2 ");
  }
  SUBCASE("it left") {
    desk.scheduler.leave({1});
    desk.join(3, "third", {1'000'000}, 0);
    desk.scheduler.set_room({2}, 1);
    CHECK(desk.hand_out() == "longer@2 ");
    desk.done(2, "longer");
    desk.scheduler.set_room({2}, 1);
    CHECK(desk.hand_out() == "then@2 ");
    CHECK(desk.plan.home(5) == 2);
  }
  SUBCASE("it is the only one") {
    desk.scheduler.leave({2});
    desk.scheduler.set_room({1}, 1);
    CHECK(desk.hand_out() == "longer@1 ");
  }
}

TEST_CASE("one suspect at a time is given to a worker, beside other jobs") {
  ScheduleDesk desk({make_job("suspect", 9), make_job("other suspect", 8), make_job("job", 7)});
  desk.scheduler.suspect(key_of(make_job("suspect")));
  desk.scheduler.suspect(key_of(make_job("other suspect")));
  desk.join(1, "a");
  CHECK(desk.hand_out() == "suspect@1 job@1 ");
  desk.done(1, "suspect");
  desk.now += FarmTime(1000);
  CHECK(desk.hand_out() == "other suspect@1 ");
}

}  // namespace
}  // namespace meshfarm::test
