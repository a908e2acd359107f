// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

// Events of a run, for observers only.

struct RunBegan {
  std::uint32_t epoch = 0;
  std::string host;
};
struct WorkerJoined {
  WorkerId worker;
  std::string host;
  std::uint32_t pid = 0;
  Capacity capacity;
};
struct WorkerLeft {
  WorkerId worker;
  std::string why;
};
struct JobAccepted {
  WorkerId worker;  // who did it; 0: the sink
  JobKey key;
  Job job;
  JobPlace place;
  std::uint64_t output_bytes = 0;
  JobTimes times;
};
struct AttemptFailed {
  WorkerId worker;
  JobKey key;
  std::string reason;
};
using FarmEvent = std::variant<RunBegan, WorkerJoined, WorkerLeft, JobAccepted, AttemptFailed>;

}  // namespace meshfarm
