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

/// Descriptors that each worker takes in the ventilator: its lane, how that is watched,
/// connections.
inline constexpr std::uint32_t k_files_per_worker = 6;

struct VentilatorOptions {
  std::string bind = "127.0.0.1";  // address or interface, never all by default
  std::uint16_t first_port = 0;    // 0: any; else control and lanes use this one and those after
  std::uint16_t last_port = 0;
  SecurityOptions security;
  std::uint64_t run = 0;        // the run's key: peers of another run are refused
  std::uint32_t algorithm = 0;  // workers and sinks of another version are refused
  std::chrono::milliseconds heartbeat{1000};
  std::chrono::milliseconds hang{30'000};  // a job that makes no progress for so long hangs
  SchedulerOptions schedule = {};
  std::uint32_t max_attempts = 3;       // a job that failed this often is given up
  WhenFull when_full = WhenFull::wait;  // of the stage
  /// Once the run is over for a reason that the sink was told, or would have been if it was there;
  /// whatever else is thrown nobody else knows of. May be empty.
  std::function<void(bool sink_was_told)> ended;
  std::function<void(const FarmProgress&)> progress;  // about twice a second; may be empty
  /// What happens, and the ventilator's age; may be empty.
  std::function<void(const FarmEvent&, FarmTime)> event;
  /// How the farm stands, once a second, or more seldom where there are hundreds of workers.
  std::function<void(const FarmProgress&, const std::vector<WorkerStatus>&, FarmTime)> state;
  const std::atomic<bool>* stop = nullptr;  // set by a signal: stop, resumable
  /// Asked when there was no sink for `patience`: whether a sink has made the run's output already,
  /// perhaps while a ventilator was killed and started again. Then the run ends. May be empty.
  std::function<bool()> was_completed;
  /// And how long to wait for a worker with the memory for what is left to do.
  std::chrono::milliseconds patience{60'000};
};

/// Hands out the jobs of `source` over one lane a worker until the sink has them all and says that
/// the run is complete. Publishes its address in the stage as a new epoch.
/// Throws IncompleteError when stopped, when the stage is full or jobs cost workers their lives,
/// DataError when jobs failed for good (named with reasons).
FarmProgress run_ventilator(const Stage& stage, const JobSource& source,
                            const VentilatorOptions& options);

}  // namespace meshfarm
