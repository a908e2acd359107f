// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/worker_report.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/security.hpp>

namespace meshfarm {

struct WorkerOptions {
  Capacity capacity;      // reported to the ventilator
  std::uint64_t run = 0;  // serves this run only; 0: any
  std::uint32_t algorithm =
      0;                      // version of what does the jobs: a run takes workers of its own only
  std::uint32_t buffer = 16;  // jobs that may wait; more are requested below 0.8 of it
  SecurityOptions security;
  /// How long to look for a ventilator, at the start and after losing one, before giving up.
  std::chrono::milliseconds patience{60'000};
  const std::atomic<bool>* stop = nullptr;  // set by a signal: give back all jobs and leave
  std::chrono::milliseconds grace{5000};    // for jobs in work to give up when leaving
  /// Called instead of returning when jobs in work do not give up: must end the process, since
  /// their threads cannot be ended. `incomplete` is the message of an IncompleteError; empty: the
  /// run is over.
  std::function<void(const std::string& incomplete)> abort;
};

/// Finds the ventilator's address in the stage, takes jobs from its lane, does them with `work`, as
/// many concurrently as it has threads, and reports each to the sink, until the ventilator says
/// that the run is over. One more job is in work than is computed: while the others compute, its
/// inputs are read ahead if they fit into its estimated memory, or its output is written. Throws
/// IncompleteError when stopped or when no ventilator is found in time.
WorkerReport run_worker(const Stage& stage, const JobFunction& work, const WorkerOptions& options);

}  // namespace meshfarm
