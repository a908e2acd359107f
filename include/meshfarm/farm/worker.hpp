// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct WorkerOptions {
  Capacity capacity;  // what the ventilator is told of this worker
  std::uint32_t buffer =
      3;  // jobs held beside the one in work; a batch is asked for below 0.8 of it
  /// How long to look for a ventilator, at the start and after losing one, before giving up.
  std::chrono::milliseconds patience{60'000};
  const std::atomic<bool>* stop = nullptr;  // set by a signal: give back what is held, and leave
};

struct WorkerReport {
  std::uint64_t jobs_done = 0;
  std::uint64_t jobs_failed = 0;
};

/// Finds the ventilator's address in the stage, takes jobs from its lane, does them with `work` on
/// a compute thread, and reports each to the sink, until the ventilator says that the run is over.
/// Throws IncompleteError when stopped or when no ventilator is found in time.
WorkerReport run_worker(const Stage& stage, const JobFunction& work, const WorkerOptions& options);

}  // namespace meshfarm
