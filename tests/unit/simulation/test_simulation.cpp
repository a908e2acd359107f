// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "simulation/faults_of_seed.hpp"
#include "simulation/made_up_run.hpp"
#include "simulation/simulated_storage.hpp"
#include "simulation/simulation_checks.hpp"

namespace meshfarm::test {
namespace {

SimulationOptions farm_of(std::uint32_t workers, const SimulatedFaults& faults) {
  SimulationOptions options;
  options.faults = faults;
  for (std::uint32_t i = 0; i < workers; ++i) {
    options.workers.push_back({i % 3 == 2 ? 0.4 : 1, i / 2, SimulatedTime(i * 7919 % 3000 * 1000)});
  }
  return options;
}

void check_seeds(const SimulatedFaults& faults, int seeds) {
  const JobSource source = simulated_jobs(60);
  const std::vector<std::string> expected = expected_summaries(source);
  REQUIRE(expected.size() == 60);
  SimulationOptions options = farm_of(6, faults);
  for (int seed = 1; seed <= seeds; ++seed) {
    CAPTURE(seed);
    options.seed = static_cast<std::uint64_t>(seed);
    options.through_wire = seed % 8 == 0;
    const SimulationResult result = simulate_farm(source, options);
    CAPTURE(result.failure);
    CAPTURE(result.time.count());
    REQUIRE(problem_of(result, options.faults, expected) == "");
  }
}

TEST_CASE("a farm without faults ends, for every seed") {
  check_seeds({}, 100);
}

TEST_CASE("lost, late, repeated and overtaking messages only cost time") {
  check_seeds({.lose = 0.03}, 100);
  check_seeds({.late = 0.02}, 100);
  check_seeds({.duplicate = 0.2, .overtake = 0.3}, 100);
  check_seeds({.lane_fails = 0.3}, 50);
}

TEST_CASE("hosts may be cut off, in one direction or both, and come back") {
  check_seeds({.host_cuts = 1}, 200);
}

TEST_CASE("workers may hang and come back, be killed and others come") {
  check_seeds({.worker_pauses = 1}, 200);
  check_seeds({.worker_crashes = 1}, 200);
  check_seeds({.crash_at_job = 0.05}, 200);
}

TEST_CASE("jobs may hang: their workers are given up") {
  check_seeds({.hang = 0.02}, 100);
}

TEST_CASE("sink and ventilator may hang, or be killed and started again") {
  check_seeds({.sink_crashes = 6, .ventilator_crashes = 6}, 200);
  check_seeds({.sink_pauses = 6, .ventilator_pauses = 6}, 200);
}

TEST_CASE("storage may be late, full, slow and wrong") {
  check_seeds({.read_error = 0.01, .write_error = 0.01, .lost_answer = 0.02}, 100);
  check_seeds({.damaged = 0.02, .unseen = 0.01, .stale = 0.05}, 100);
  check_seeds({.storage_stalls = 4}, 100);
  check_seeds({.disk_fills = 2}, 100);
}

TEST_CASE("workers may be asked to leave, and give back what they hold") {
  check_seeds({.worker_leaves = 2}, 100);
  check_seeds({.hang = 0.01, .worker_leaves = 2}, 50);
}

TEST_CASE("the journal may fail, and be full") {
  check_seeds({.journal_error = 0.02}, 50);
  check_seeds({.sink_crashes = 3, .disk_fills = 4}, 50);
}

/// Like farm_of(), but with one host per worker: the number of histories in which a host was
/// banned.
int bans_in(const SimulatedFaults& faults, std::uint64_t seeds) {
  const JobSource source = simulated_jobs(120);
  const std::vector<std::string> expected = expected_summaries(source);
  SimulationOptions options = farm_of(6, faults);
  for (std::uint32_t i = 0; i < options.workers.size(); ++i) options.workers[i].host = i;
  int bans = 0;
  for (options.seed = 1; options.seed <= seeds; ++options.seed) {
    CAPTURE(options.seed);
    const SimulationResult result = simulate_farm(source, options);
    CAPTURE(result.failure);
    REQUIRE(problem_of(result, faults, expected) == "");
    bans += result.banned_hosts.empty() ? 0 : 1;
  }
  return bans;
}

TEST_CASE("a sink that cannot read what others can costs no host its name") {
  CHECK(bans_in({.sick_sink = 2}, 60) == 0);
}

TEST_CASE("parts that nobody can read for minutes cost no host its name") {
  // A part may be readable again just when another host tries: then the first is blamed, but
  // rarely.
  CHECK(bans_in({.lost_parts = 0.15}, 60) <= 1);
}

TEST_CASE("a host that cannot read what others can only costs time") {
  check_seeds({.sick_mounts = 0.5}, 100);
}

TEST_CASE("addresses may be seen late, and lead to other runs that nobody answers for") {
  check_seeds({.late_endpoint = 0.5, .ventilator_crashes = 6}, 100);
  check_seeds({.other_runs = 10, .ventilator_crashes = 3}, 100);
}

TEST_CASE("readers may wait for files that are not to be seen, and nobody is held to hang") {
  const JobSource source = simulated_jobs(60);
  SimulationOptions options = farm_of(6, {.unseen = 0.2});
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    const SimulationResult result = simulate_farm(source, options);
    REQUIRE(problem_of(result, options.faults, expected_summaries(source)) == "");
  }
}

TEST_CASE("workers of several threads and little memory, shared or not, and a static schedule") {
  const JobSource source = simulated_jobs(60);
  const std::vector<std::string> expected = expected_summaries(source);
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    CAPTURE(seed);
    SimulationOptions options = farm_of(6, {.worker_crashes = 0.5, .worker_leaves = 0.5});
    options.seed = seed;
    if (seed % 3 == 0) options.schedule = {Schedule::fixed, 6};
    for (SimulatedWorker& worker : options.workers) {
      worker.threads = static_cast<std::uint32_t>(1 + seed % 4);
      worker.memory = (std::uint64_t{1} << 30) + (seed << 20);
      if (seed % 2 == 0) worker.memory_pool = worker.host + 1;
    }
    REQUIRE(problem_of(simulate_farm(source, options), options.faults, expected) == "");
  }
}

TEST_CASE("where the disk is full a run waits, or is started again by its user") {
  const JobSource source = simulated_jobs(200);
  const std::vector<std::string> expected = expected_summaries(source);
  std::uint32_t runs = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    SimulationOptions options = farm_of(6, {.disk_fills = 6});
    options.seed = seed;
    const SimulationResult waits = simulate_farm(source, options);
    REQUIRE(problem_of(waits, options.faults, expected) == "");
    CHECK(waits.runs == 1);
    options.when_full = WhenFull::end;
    const SimulationResult ends = simulate_farm(source, options);
    REQUIRE(problem_of(ends, options.faults, expected) == "");
    runs += ends.runs;
  }
  CHECK(runs > 50);
}

TEST_CASE("everything at once, each seed with a mix of its own") {
  const JobSource source = simulated_jobs(100);
  const std::vector<std::string> expected = expected_summaries(source);
  int hopeless = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    SimulationOptions options = farm_of(12, faults_of_seed(seed));
    options.seed = seed;
    const SimulationResult result = simulate_farm(source, options);
    CAPTURE(result.failure);
    REQUIRE(problem_of(result, options.faults, expected) == "");
    if (!result.failure.empty()) ++hopeless;
  }
  CHECK(hopeless > 10);  // runs with a job that cannot be done
  CHECK(hopeless < 100);
}

TEST_CASE("one seed gives one history, another seed another") {
  const JobSource source = simulated_jobs(60);
  SimulationOptions options = farm_of(6, faults_of_seed(1234));
  options.seed = 1234;
  const std::uint64_t history = simulate_farm(source, options).trace_hash;
  CHECK(simulate_farm(source, options).trace_hash == history);
  options.through_wire = true;  // nothing is lost in translation
  CHECK(simulate_farm(source, options).trace_hash == history);
  options.seed = 1235;
  CHECK(simulate_farm(source, options).trace_hash != history);
}

TEST_CASE("a job that kills its workers is given up, the others are done") {
  SimulatedFaults faults;
  faults.poison = "job 7";
  faults.end = SimulatedTime(0);
  const SimulationResult result = simulate_farm(simulated_jobs(20), farm_of(5, faults));
  CHECK(result.ended);
  CHECK(result.broken == "");
  CHECK(doctest::String(result.failure.c_str()) == doctest::Contains("1 job failed for good"));
  CHECK(result.jobs.size() == 17);  // 18 are in the first stage
}

TEST_CASE("a job that no attempt can do is tried once") {
  SimulatedFaults faults;
  faults.bad = "job 7";
  faults.end = SimulatedTime(0);
  const SimulationResult result = simulate_farm(simulated_jobs(20), farm_of(5, faults));
  CHECK(result.ended);
  CHECK(doctest::String(result.failure.c_str()) == doctest::Contains("no mesh can come of this"));
  CHECK(result.pushes <= 20);  // no more than second attempts at the last of the 18
}

TEST_CASE("a thousand workers share ten thousand jobs") {
  SimulatedFaults faults;
  faults.end = SimulatedTime(0);
  const JobSource source = simulated_jobs(10'000);
  const auto start = std::chrono::steady_clock::now();
  const SimulationResult result = simulate_farm(source, farm_of(1000, faults));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  CHECK(problem_of(result, faults, expected_summaries(source)) == "");
  MESSAGE(result.events, " events in ", took.count(), " s");
}

TEST_CASE("a host keeps the last that it has read, as far as there is memory") {
  HostCache cache;
  cache.keep({1, 40}, 100);
  cache.keep({2, 50}, 100);
  CHECK(cache.has(1) == 40);
  CHECK(cache.has(2) == 50);
  CHECK(cache.has(0) == 0);
  cache.keep({0, 20}, 100);  // data that nobody else reads
  CHECK(cache.has(1) == 0);
  CHECK(cache.has(2) == 50);
  cache.keep({3, 101}, 100);
  CHECK(cache.has(2) == 0);
  CHECK(cache.has(3) == 0);
  cache.keep({4, 100}, 100);
  CHECK(cache.has(4) == 100);
}

// --- the simulation would notice

Assignment push(std::uint64_t lane_seq, std::uint32_t attempt) {
  return {7, 1, lane_seq, attempt, {}};
}

TEST_CASE("the checks notice what must never happen") {
  SimulationChecks checks;
  const WorkerId first{1};
  const WorkerId second{2};
  const WorkerId third{3};
  for (const WorkerId each : {first, second, third}) checks.credit(each, 2);
  checks.pushed(first, {5}, push(1, 1));
  CHECK(checks.broken() == "");
  SUBCASE("more than the credit") {
    checks.pushed(first, {6}, push(2, 1));
    CHECK(checks.broken() == "");
    checks.pushed(first, {7}, push(3, 1));
    CHECK(checks.broken() == "a worker was sent more than its credit");
  }
  SUBCASE("a third live attempt") {
    checks.pushed(second, {5}, push(1, 2));
    CHECK(checks.broken() == "");
    checks.pushed(third, {5}, push(1, 3));
    CHECK(checks.broken() == "a job has more than two live attempts");
  }
  SUBCASE("a third attempt once one has ended is fine") {
    checks.pushed(second, {5}, push(1, 2));
    checks.lane_closed(first);
    checks.pushed(third, {5}, push(1, 3));
    CHECK(checks.broken() == "");
  }
  SUBCASE("an attempt number used again") {
    checks.lane_closed(first);
    checks.pushed(second, {5}, push(1, 1));
    CHECK(checks.broken() == "an attempt number was used again");
  }
  SUBCASE("a job accepted twice, or without its file") {
    checks.journalled({5}, true);
    CHECK(checks.broken() == "");
    SUBCASE("twice") {
      checks.journalled({5}, true);
      CHECK(checks.broken() == "a job was accepted twice");
    }
    SUBCASE("without") {
      checks.journalled({6}, false);
      CHECK(checks.broken() == "a job was accepted whose file is not whole");
    }
  }
}

TEST_CASE("a history that ends as it must not is a problem") {
  const JobSource source = simulated_jobs(20);
  const std::vector<std::string> expected = expected_summaries(source);
  SimulatedFaults none;
  none.end = SimulatedTime(0);
  SimulationResult result = simulate_farm(source, farm_of(2, none));
  CHECK(problem_of(result, none, expected) == "");
  result.outputs[3].output.summary += "x";
  CHECK(problem_of(result, none, expected) == "it ended with other bytes");
  none.bad = "job 7";
  CHECK(problem_of(result, none, expected) == "a job that cannot be done was done");
  SimulationOptions hasty = farm_of(2, {});
  hasty.limit = SimulatedTime(1'000'000);
  CHECK(problem_of(simulate_farm(source, hasty), {}, expected) == "it did not come to its end");
}

}  // namespace
}  // namespace meshfarm::test
