// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "farm_simulation.hpp"

namespace meshfarm::test {
namespace {

/// `count` jobs, then one that depends on all of them, then `count` more.
JobSource three_rounds(std::size_t count) {
  return [count](std::span<const AcceptedJob> accepted) -> std::vector<Job> {
    if (accepted.empty()) return make_jobs(count);
    if (accepted.size() == count) return {make_job("all of " + accepted.back().output.summary)};
    if (accepted.size() == count + 1) return make_jobs(count, "again ");
    return {};
  };
}

void check_outputs(const FarmSimulation& world, std::size_t count) {
  REQUIRE(world.outputs);
  REQUIRE(world.outputs->size() == 2 * count + 1);
  std::vector<Job> jobs = make_jobs(count);
  jobs.push_back(make_job("all of " + reversed(jobs.back().parameters)));
  for (const Job& job : make_jobs(count, "again ")) jobs.push_back(job);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    CHECK((*world.outputs)[i].output.summary == reversed(jobs[i].parameters));
  }
}

void check_seeds(const Faults& faults, int seeds) {
  for (int seed = 1; seed <= seeds; ++seed) {
    CAPTURE(seed);
    FarmSimulation world(three_rounds(20), 5, faults, static_cast<std::uint64_t>(seed));
    const bool ended = world.run(FarmTime(900'000));
    CAPTURE(world.now().count());
    CAPTURE(world.failure.value_or("(none)"));
    CHECK(world.broken == "");
    REQUIRE(ended);
    CHECK(world.failure == "");
    check_outputs(world, 20);
  }
}

TEST_CASE("a farm without faults ends, for every seed") {
  check_seeds({}, 100);
}

TEST_CASE("lost messages only cost time") {
  check_seeds({.lose = 0.03}, 200);
}

TEST_CASE("workers may hang and come back") {
  check_seeds({.pause = 0.003}, 200);
}

TEST_CASE("workers may be killed and others come") {
  check_seeds({.crash = 0.05}, 200);
}

TEST_CASE("sink and ventilator may be killed and started again") {
  check_seeds({.sink_crash = 0.01, .vent_crash = 0.01}, 200);
}

TEST_CASE("results may be damaged and jobs may fail now and then") {
  check_seeds({.fail = 0.01, .damaged = 0.01}, 100);
}

TEST_CASE("all at once") {
  check_seeds(
      {.lose = 0.01, .damaged = 0.001, .sink_crash = 0.004, .vent_crash = 0.004, .pause = 0.004},
      300);
}

TEST_CASE("one seed gives one history") {
  const Faults faults{.lose = 0.01, .sink_crash = 0.004, .pause = 0.004};
  std::uint64_t history[2] = {0, 0};
  for (std::uint64_t& each : history) {
    FarmSimulation world(three_rounds(20), 5, faults, 1234);
    REQUIRE(world.run(FarmTime(900'000)));
    each = world.history;
  }
  CHECK(history[0] == history[1]);
}

TEST_CASE("a job that kills its workers is given up after five, the others are done") {
  const JobSource source = [](std::span<const AcceptedJob> accepted) {
    return accepted.empty() ? make_jobs(10) : std::vector<Job>{};
  };
  FarmSimulation world(source, 5, {.poison = "job 7"}, 1);
  CHECK_FALSE(world.run(FarmTime(300'000)));
  REQUIRE(world.failure);
  CHECK(doctest::String(world.failure->c_str()) == doctest::Contains("1 job failed for good"));
  CHECK(world.journalled.size() == 9);
}

TEST_CASE("a thousand workers share ten thousand jobs") {
  const auto start = std::chrono::steady_clock::now();
  FarmSimulation world(three_rounds(5000), 1000, {}, 1);
  REQUIRE(world.run(FarmTime(900'000)));
  check_outputs(world, 5000);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  MESSAGE(world.events, " events in ", took.count(), " s");
}

}  // namespace
}  // namespace meshfarm::test
