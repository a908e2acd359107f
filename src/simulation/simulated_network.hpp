// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/simulation/simulation.hpp>

#include "simulation/dice.hpp"
#include "simulation/event_queue.hpp"

namespace meshfarm {

/// One direction of a connection: messages arrive in order, as with TCP.
struct SimulatedChannel {
  std::uint32_t from = 0;  // hosts
  std::uint32_t to = 0;
  SimulatedTime last{0};  // arrival of the last message
};

/// Delivers messages late, twice or never; hosts can be cut off.
class SimulatedWires {
 public:
  SimulatedWires(const SimulationOptions& options, std::uint32_t hosts, Dice& dice,
                 EventQueue& queue)
      : network_(options.network),
        faults_(options.faults),
        dice_(dice),
        queue_(queue),
        cuts_(hosts) {}

  enum class Order { kept, may_change };
  template <class Event>
  void send(SimulatedChannel& channel, Order order, Event deliver) {
    const Arrivals arrivals = route(channel, order);
    if (arrivals.again) queue_.at(*arrivals.again, deliver);
    if (arrivals.first) queue_.at(*arrivals.first, std::move(deliver));
  }
  /// Messages from and to the host are held back until then, or lost.
  void cut(std::uint32_t host, SimulatedTime until);

 private:
  struct Cut {
    SimulatedTime sends_again{0};
    SimulatedTime hears_again{0};
    bool loses = false;
  };
  struct Arrivals {
    std::optional<SimulatedTime> first;
    std::optional<SimulatedTime> again;
  };
  Arrivals route(SimulatedChannel& channel, Order order);
  bool faulty() const { return queue_.now() < faults_.end; }

  const SimulatedNetwork& network_;
  const SimulatedFaults& faults_;
  Dice& dice_;
  EventQueue& queue_;
  std::vector<Cut> cuts_;
};

}  // namespace meshfarm
