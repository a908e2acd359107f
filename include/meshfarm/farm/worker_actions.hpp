// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The actions that WorkerCore (worker_core.hpp) asks its surrounding process to take.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <meshfarm/farm/membership.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

struct ConnectLane {
  std::string address;
};
/// Empty: no sink for now.
struct ConnectSink {
  std::string address;
};
struct SendResult {
  Result result;
};
/// Start the job in this slot, which is free; answered by finished().
struct Begin {
  std::uint32_t slot = 0;
  std::uint32_t attempt = 0;
  JobKey key;
  Job job;
};
/// Ask the slot's job to give up; it still answers with finished().
struct GiveUp {
  std::uint32_t slot = 0;
};
/// How long to keep trying: a host that has never looked for a file sees it as soon as it exists.
inline constexpr FarmTime k_second_reader_waits{30'000};
/// Try to read a file that the sink cannot read; answered by tried().
struct ReadForSink {
  TryRead what;
};
/// Leave; `incomplete` says why the run is not over. With `abort`, jobs are still in work that do
/// not respond, and must not be waited for.
struct Leave {
  std::string incomplete;
  bool abort = false;
};
using WorkerAction = std::variant<Look, Dial, HangUp, Say, ConnectLane, ConnectSink, SendResult,
                                  Begin, GiveUp, ReadForSink, Leave>;
using WorkerActions = std::vector<WorkerAction>;

}  // namespace meshfarm
