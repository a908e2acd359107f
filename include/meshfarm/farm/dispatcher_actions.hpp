// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What the ventilator's mind (dispatcher.hpp) asks the process round it to do.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <meshfarm/farm/farm_event.hpp>
#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

/// A peer on the control channel, as its transport names it.
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
/// The ventilator's work is over; `failure` says why the run could not be completed, and
/// `resumable` that the same run may be, later.
struct Finish {
  std::string failure;
  bool resumable = false;
};
/// Try whether so many bytes can be written to the stage; answered by probed().
struct ProbeStage {
  std::uint64_t bytes = 0;
};
/// Nothing to do: for those who watch.
struct Tell {
  FarmEvent event;
};
using Action = std::variant<SendTo, OpenLane, CloseLane, PushJob, Finish, ProbeStage, Tell>;
using Actions = std::vector<Action>;

}  // namespace meshfarm
