// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace meshfarm {

/// The jobs of a history: a few stages that suffice to go wrong in every way, or all stages of a
/// run that cuts its input and finishes its result by jobs.
enum class SimulatedGraph { few_stages, whole_run };

/// Histories simulated to test correctness: each seed has its own mix of faults.
struct SeedsOptions {
  std::uint64_t first = 1;
  std::uint64_t count = 0;
  std::uint32_t workers = 24;  // every third is slower; two per host
  std::uint64_t jobs = 1024;   // approximate number in a whole run
  SimulatedGraph graph = SimulatedGraph::few_stages;
  unsigned threads = 0;  // 0: one per core
};

struct SeedProblem {
  std::uint64_t seed = 0;
  std::string what;
};

struct SeedsResult {
  std::uint64_t events = 0;
  double virtual_s = 0;               // of all histories together
  std::uint64_t trace_hash = 0;       // of all histories, in the order of the seeds
  std::vector<SeedProblem> problems;  // ascending by seed
};

/// The result does not depend on the number of threads.
SeedsResult simulate_seeds(const SeedsOptions& options);

}  // namespace meshfarm
