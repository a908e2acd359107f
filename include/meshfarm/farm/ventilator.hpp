// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/security.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// What the farm is doing, for progress lines.
struct FarmProgress {
  std::uint64_t jobs_done = 0;
  std::uint64_t jobs_known = 0;
  std::uint64_t cost_done = 0;  // triangles of the jobs accepted
  std::uint64_t cost_known = 0;
  std::uint64_t jobs_running = 0;
  std::uint32_t workers = 0;
  std::uint32_t workers_lost = 0;
  std::uint32_t retries = 0;
  bool sink_present = false;
  std::uint64_t refused = 0;  // connections that did not prove to belong to the run
};

struct VentilatorOptions {
  std::string bind = "127.0.0.1";  // address or interface, never all by default
  std::uint16_t first_port = 0;    // 0: any; else control and lanes use this one and those after
  std::uint16_t last_port = 0;
  SecurityOptions security;
  std::uint64_t run = 0;  // the run's key: peers of another run are refused
  std::chrono::milliseconds heartbeat{1000};
  std::uint32_t max_attempts = 3;                     // a job that failed this often is given up
  std::function<void(const FarmProgress&)> progress;  // about twice a second; may be empty
  const std::atomic<bool>* stop = nullptr;            // set by a signal: stop, resumable
};

/// Hands out the jobs of `source` over one lane a worker until the sink has them all and says that
/// the run is complete. Publishes its address in the stage as a new epoch.
/// Throws IncompleteError when stopped, DataError when jobs failed for good (named with reasons).
FarmProgress run_ventilator(const Stage& stage, const JobSource& source,
                            const VentilatorOptions& options);

}  // namespace meshfarm
