// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The actions that Dispatcher (dispatcher.hpp) asks its surrounding process to take.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <meshfarm/farm/farm_event.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

/// A peer on the control channel, as the transport names it.
using PeerId = std::string;

struct SendTo {
  PeerId peer;
  Message message;
};
/// Answered by lane_opened() or lane_failed().
struct OpenLane {
  WorkerId worker;
};
struct CloseLane {
  WorkerId worker;
};
struct PushJob {
  WorkerId worker;
  JobKey key;
  Assignment assignment;
};
/// The ventilator is finished. `failure` says why the run could not be completed; `resumable` says
/// that the same run may still be completed later.
struct Finish {
  std::string failure;
  bool resumable = false;
};
/// Try to write this many bytes to the stage; answered by probed().
struct ProbeStage {
  std::uint64_t bytes = 0;
};
/// Requires no action: for observers only.
struct Tell {
  FarmEvent event;
};
using Action = std::variant<SendTo, OpenLane, CloseLane, PushJob, Finish, ProbeStage, Tell>;
using Actions = std::vector<Action>;

}  // namespace meshfarm
