// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

/// The state of the farm, for progress lines.
struct FarmProgress {
  std::uint64_t jobs_done = 0;
  std::uint64_t jobs_known = 0;
  std::uint64_t cost_done = 0;  // triangles of the accepted jobs
  std::uint64_t cost_known = 0;
  std::vector<StageProgress> stages;
  std::uint64_t jobs_running = 0;
  std::uint64_t jobs_failed = 0;
  std::uint64_t jobs_too_big = 0;  // ready, but need more memory than any worker has
  std::uint32_t workers = 0;
  std::uint32_t workers_lost = 0;
  std::uint32_t retries = 0;
  bool sink_present = false;
  std::uint64_t refused = 0;           // connections that failed to authenticate
  std::string other_build;             // who was last refused for its build, and why
  bool storage_stalls = false;         // most workers wait for the stage
  bool no_room = false;                // the stage is full, and everyone waits for room
  std::vector<std::string> bad_hosts;  // get no more jobs after too many failures in a row
};

/// One worker as the ventilator sees it.
struct WorkerStatus {
  WorkerId id;
  std::string host;
  std::uint32_t pid = 0;
  Capacity capacity;
  double speed = 0;  // triangles per second and thread, from completed jobs
  std::uint32_t held = 0;
  std::uint64_t rss_bytes = 0;
  FarmTime silent{0};      // since its last message
  std::uint64_t room = 0;  // additional jobs that it may be sent
};

}  // namespace meshfarm
