// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "simulation/made_up_run.hpp"

namespace meshfarm::test {
namespace {

using Serves = SimulatedWorker::Serves;

/// Two runs of one stage, and their expected outcomes.
struct TwoRuns {
  JobSource source = simulated_jobs(80);
  JobSource other = simulated_jobs(60, "other ");
  std::vector<std::string> expected = expected_summaries(source);
  std::vector<std::string> other_expected = expected_summaries(other);
};

SimulationOptions simulated_farm(const TwoRuns& runs, const std::vector<Serves>& workers) {
  SimulationOptions options;
  options.other = runs.other;
  for (std::uint32_t i = 0; i < workers.size(); ++i) {
    SimulatedWorker worker;
    worker.host = i / 2;
    worker.start = SimulatedTime(i * 7919 % 3000 * 1000);
    worker.serves = workers[i];
    options.workers.push_back(worker);
  }
  return options;
}

SimulationResult check(const TwoRuns& runs, const SimulationOptions& options) {
  SimulationResult result = simulate_farm(runs.source, options);
  CAPTURE(options.seed);
  REQUIRE(problem_of(result, options.faults, runs.expected, runs.other_expected) == "");
  return result;
}

std::set<JobKey> keys_of(const std::vector<AcceptedJob>& jobs) {
  std::set<JobKey> keys;
  for (const AcceptedJob& each : jobs) keys.insert(each.key);
  return keys;
}

TEST_CASE("two runs of one stage end, each with its bytes, and each has the workers it was given") {
  const TwoRuns runs;
  SimulationOptions options = simulated_farm(
      runs, {Serves::first, Serves::other, Serves::any, Serves::pool, Serves::first, Serves::any});
  for (options.seed = 1; options.seed <= 50; ++options.seed) {
    options.other_start = std::chrono::seconds(options.seed % 20);
    const SimulationResult result = check(runs, options);
    const std::set<JobKey> first = keys_of(result.outputs);
    const std::set<JobKey> other = keys_of(result.other_outputs);
    CHECK(first != other);
    for (const SimulatedJob& job : result.jobs) {
      const Serves serves = options.workers[job.worker].serves;
      if (serves == Serves::first) CHECK(first.contains(job.key));
      if (serves == Serves::other) CHECK(other.contains(job.key));
    }
  }
}

TEST_CASE("a run that is over is passed by: its workers serve the one that is not") {
  const TwoRuns runs;
  SimulationOptions options = simulated_farm(runs, {Serves::any, Serves::any, Serves::pool});
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    options.other_start = std::chrono::seconds(3 * options.seed);
    check(runs, options);
  }
}

TEST_CASE("two runs with each kind of fault") {
  const TwoRuns runs;
  for (const SimulatedFaults& faults :
       std::vector<SimulatedFaults>{{.lose = 0.02, .duplicate = 0.1, .late = 0.01},
                                    {.worker_crashes = 1, .worker_leaves = 1},
                                    {.host_cuts = 1},
                                    {.late_endpoint = 0.5, .other_runs = 6},
                                    {.sink_crashes = 4, .ventilator_crashes = 4},
                                    {.sink_pauses = 4, .ventilator_pauses = 4}}) {
    SimulationOptions options = simulated_farm(
        runs, {Serves::first, Serves::other, Serves::any, Serves::pool, Serves::any});
    options.faults = faults;
    for (options.seed = 1; options.seed <= 60; ++options.seed) {
      options.other_start = std::chrono::seconds(options.seed % 15);
      check(runs, options);
    }
  }
}

TEST_CASE("a run that fails leaves the other alone") {
  const TwoRuns runs;
  SimulationOptions options =
      simulated_farm(runs, {Serves::first, Serves::other, Serves::any, Serves::pool, Serves::any});
  options.faults.bad = "job 70";  // the other run has another job in its place
  options.faults.end = {};
  const SimulationResult result = check(runs, options);
  CHECK(!result.failure.empty());
  CHECK(result.other_outputs.size() == runs.other_expected.size());
}

TEST_CASE("what is wrong with the other run is told") {
  const TwoRuns runs;
  SimulationResult result =
      simulate_farm(runs.source, simulated_farm(runs, {Serves::first, Serves::other}));
  const auto problem = [&] { return problem_of(result, {}, runs.expected, runs.other_expected); };
  CHECK(problem().empty());
  result.other_outputs.pop_back();
  CHECK(problem() == "the other run: it ended with other bytes");
  result.other_failure = "no luck";
  CHECK(problem() == "the other run: it failed: no luck");
}

TEST_CASE("a run without a worker of its own does not end") {
  const TwoRuns runs;
  SimulationOptions options = simulated_farm(runs, {Serves::first, Serves::first});
  options.limit = std::chrono::minutes(5);
  const SimulationResult result = simulate_farm(runs.source, options);
  CHECK(problem_of(result, {}, runs.expected, runs.other_expected) == "it did not come to its end");
  CHECK(result.outputs.size() == runs.expected.size());
}

}  // namespace
}  // namespace meshfarm::test
