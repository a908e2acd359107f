// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What the worker's mind (worker_core.hpp) asks the process round it to do.
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
/// Empty: there is no sink for now.
struct ConnectSink {
  std::string address;
};
struct SendResult {
  Result result;
};
/// Work on the job in this slot, which is free; answered by finished().
struct Begin {
  std::uint32_t slot = 0;
  std::uint32_t attempt = 0;
  JobKey key;
  Job job;
};
/// Ask the slot's job to be given up; it still answers with finished().
struct GiveUp {
  std::uint32_t slot = 0;
};
/// How long that is tried: whoever has never looked for a file before sees it when it is there.
inline constexpr FarmTime k_second_reader_waits{30'000};
/// Try to read a file that the sink cannot; answered by tried().
struct ReadForSink {
  TryRead what;
};
/// The end; `incomplete` says why the run is not over. If it is an abort, jobs are still in work:
/// they do not listen, and may not be waited for.
struct Leave {
  std::string incomplete;
  bool abort = false;
};
using WorkerAction = std::variant<Look, Dial, HangUp, Say, ConnectLane, ConnectSink, SendResult,
                                  Begin, GiveUp, ReadForSink, Leave>;
using WorkerActions = std::vector<WorkerAction>;

}  // namespace meshfarm
