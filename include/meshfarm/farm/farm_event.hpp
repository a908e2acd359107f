// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

// What happens in a run, for those who only watch it.

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
  WorkerId worker;  // who did it
  JobKey key;
  Job job;
  std::uint32_t round = 0;  // from 0: jobs of a round wait for all of those before
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
