// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <meshfarm/farm/farm_event.hpp>
#include <meshfarm/farm/farm_progress.hpp>
#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/schedule.hpp>
#include <meshfarm/farm/when_full.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/security.hpp>

namespace meshfarm {

/// File descriptors per worker in the ventilator: its lane, the lane's monitor, connections.
inline constexpr std::uint32_t k_files_per_worker = 6;

struct VentilatorOptions {
  std::string bind = "127.0.0.1";  // address or interface, never all of them by default
  std::uint16_t first_port = 0;    // 0: any; else control and lanes use this and the next ones
  std::uint16_t last_port = 0;
  SecurityOptions security;
  std::uint64_t run = 0;        // the run's key: peers of another run are refused
  std::uint32_t algorithm = 0;  // workers and sinks of another algorithm version are refused
  std::chrono::milliseconds heartbeat{1000};
  std::chrono::milliseconds hang{30'000};  // a job that makes no progress for this long hangs
  SchedulerOptions schedule = {};
  std::uint32_t max_attempts = 3;       // a job is given up after this many failed attempts
  WhenFull when_full = WhenFull::wait;  // of the stage
  /// Called when the run is over for a reason that the sink was told, or would have been told if it
  /// was there; any other exception is known to nobody else. May be empty.
  std::function<void(bool sink_was_told)> ended;
  std::function<void(const FarmProgress&)> progress;  // about twice a second; may be empty
  /// Receives the events and the ventilator's age; may be empty.
  std::function<void(const FarmEvent&, FarmTime)> event;
  /// Receives the farm's state once per second, or less often with hundreds of workers.
  std::function<void(const FarmProgress&, const std::vector<WorkerStatus>&, FarmTime)> state;
  const std::atomic<bool>* stop = nullptr;  // set by a signal: stop, resumable
  /// Called when there was no sink for `patience`: whether a sink has already made the run's
  /// output, perhaps while a ventilator was killed and restarted. If so, the run ends. May be
  /// empty.
  std::function<bool()> was_completed;
  /// Also how long to wait for a worker with enough memory for the remaining jobs.
  std::chrono::milliseconds patience{60'000};
};

/// Hands out the jobs of `source` over one lane per worker until the sink has them all and says
/// that the run is complete. Publishes its address in the stage as a new epoch. Throws
/// IncompleteError when stopped, when the stage is full or when jobs cost workers their lives,
/// DataError when jobs failed for good (naming the reasons).
FarmProgress run_ventilator(const Stage& stage, const JobSource& source,
                            const VentilatorOptions& options);

}  // namespace meshfarm
