// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <utility>

#include <meshfarm/simulation/simulated_seeds.hpp>
#include <meshfarm/util/parallel.hpp>

#include "simulation/dice.hpp"
#include "simulation/faults_of_seed.hpp"
#include "simulation/made_up_run.hpp"
#include "simulation/whole_run.hpp"

namespace meshfarm {
namespace {

/// One in this many seeds encodes its messages in the wire format; the others save the time for
/// more histories.
constexpr std::uint64_t k_wire_every = 32;
constexpr std::uint64_t k_enough_for_any_job = std::uint64_t{1} << 30;
constexpr std::uint64_t k_ends_when_full_every = 5;
/// In this share of the histories there is another run of the stage, with 1 / k_of_the_jobs as many
/// jobs.
constexpr double k_two_runs = 0.2;
constexpr std::uint64_t k_of_the_jobs = 4;
/// Otherwise a ventilator with many workers would be busy with heartbeats alone.
constexpr std::uint32_t k_workers_per_heartbeat_ms = 2;

struct SeedResult {
  std::uint64_t events = 0;
  double virtual_s = 0;
  std::uint64_t trace_hash = 0;
  std::string problem;
};

/// The jobs of a run, and their expected results.
struct Task {
  explicit Task(JobSource jobs) : source(std::move(jobs)), expected(expected_summaries(source)) {}
  JobSource source;
  std::vector<std::string> expected;
};

/// Another run begins at some time; workers are told which run to serve, or none, or choose one.
void add_other_run(SimulationOptions& options, const JobSource& other, Dice& dice) {
  using Serves = SimulatedWorker::Serves;
  constexpr std::array k_kinds = {Serves::any, Serves::first, Serves::other, Serves::pool};
  constexpr std::uint64_t k_latest_us = 20'000'000;
  options.other = other;
  options.other_start = SimulatedTime(dice.pick(k_latest_us));
  for (SimulatedWorker& worker : options.workers) {
    worker.serves = k_kinds[dice.pick(k_kinds.size())];
  }
  // Workers that are told nothing may all serve one run; each run's user has one worker for it.
  options.workers.front().serves = Serves::first;
  options.workers.back().serves = Serves::other;
  // A static schedule waits for its expected number of workers: count those that can only come to
  // it.
  const auto count = [&](Serves kind) {
    return static_cast<std::uint32_t>(
        std::count_if(options.workers.begin(), options.workers.end(),
                      [&](const SimulatedWorker& worker) { return worker.serves == kind; }));
  };
  std::uint32_t& expected = options.schedule.expect_workers;
  expected = std::min({expected, count(Serves::first), count(Serves::other)});
}

SimulationOptions farm_of(const SeedsOptions& seeds, std::uint64_t seed, const JobSource& other) {
  SimulationOptions options;
  options.seed = seed;
  options.faults = faults_of_seed(seed);
  // Most runs wait when the disk is full; the others are restarted by their user.
  if (seed % k_ends_when_full_every == 0) options.when_full = WhenFull::end;
  options.through_wire = seed % k_wire_every == 0;
  options.heartbeat =
      std::max(options.heartbeat, FarmTime(seeds.workers / k_workers_per_heartbeat_ms));
  for (std::uint32_t i = 0; i < seeds.workers; ++i) {
    SimulatedWorker worker;
    worker.speed = i % 3 == 2 ? 0.4 : 1;
    worker.host = i / 2;
    worker.start = SimulatedTime(std::uint64_t{i} * 7919 % 3000 * 1000);
    options.workers.push_back(worker);
  }
  // Uses other bits of the seed than the faults do.
  Dice dice(seed * 0x9e37'79b9 + 1);
  const bool fixed = dice.chance(0.15);
  if (fixed) {
    options.schedule.schedule = Schedule::fixed;
    // If only a few were expected, they would be dealt more than they can do within the limit,
    // while the others rest.
    options.schedule.expect_workers =
        seeds.workers - static_cast<std::uint32_t>(dice.pick(seeds.workers / 2 + 1));
  }
  const std::uint64_t threads = dice.chance(0.3) ? 4 : 1;
  const std::uint64_t memory = dice.chance(0.3) ? k_enough_for_any_job : 0;
  const bool shared = dice.chance(0.5);
  for (SimulatedWorker& worker : options.workers) {
    worker.threads = 1 + static_cast<std::uint32_t>(dice.pick(threads));
    if (memory != 0) worker.memory = memory + dice.pick(2 * memory);
    if (memory != 0 && shared) worker.memory_pool = worker.host + 1;
  }
  if (seeds.workers > 1 && dice.chance(k_two_runs)) add_other_run(options, other, dice);
  return options;
}

}  // namespace

SeedsResult simulate_seeds(const SeedsOptions& options) {
  const auto make_jobs = options.graph == SimulatedGraph::whole_run ? whole_run : simulated_jobs;
  const Task task(make_jobs(options.jobs, ""));
  const Task other(make_jobs(std::max<std::uint64_t>(1, options.jobs / k_of_the_jobs), "other "));
  std::vector<SeedResult> each(options.count);
  parallel_for(options.count, options.threads, [&](std::uint64_t i) {
    const SimulationOptions farm = farm_of(options, options.first + i, other.source);
    const SimulationResult result = simulate_farm(task.source, farm);
    each[i] = {result.events, std::chrono::duration<double>(result.time).count(), result.trace_hash,
               problem_of(result, farm.faults, task.expected,
                          farm.other ? other.expected : std::vector<std::string>{})};
  });
  SeedsResult all;
  for (std::uint64_t i = 0; i < options.count; ++i) {
    all.events += each[i].events;
    all.virtual_s += each[i].virtual_s;
    all.trace_hash = all.trace_hash * 0x100000001b3 + each[i].trace_hash;
    if (!each[i].problem.empty()) {
      all.problems.push_back({options.first + i, each[i].problem});
    }
  }
  return all;
}

}  // namespace meshfarm
