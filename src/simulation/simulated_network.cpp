// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/simulated_network.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_late_us = 8'000'000;

}  // namespace

/// When a message sent now arrives.
SimulatedWires::Arrivals SimulatedWires::route(SimulatedChannel& channel, Order order) {
  const auto jitter = static_cast<std::uint64_t>(network_.jitter.count());
  SimulatedTime arrival = queue_.now() + network_.delay + SimulatedTime(dice_.pick(jitter));
  bool keep_order = true;
  bool twice = false;
  if (faulty()) {
    if (dice_.chance(faults_.lose)) return {};
    if (dice_.chance(faults_.late)) arrival += SimulatedTime(dice_.pick(k_late_us));
    twice = dice_.chance(faults_.duplicate);
    keep_order = order == Order::kept || !dice_.chance(faults_.overtake);
  }
  const Cut& from = cuts_[channel.from];
  const Cut& to = cuts_[channel.to];
  const SimulatedTime again = std::max(from.sends_again, to.hears_again);
  if (again > queue_.now()) {
    if (from.loses || to.loses) return {};
    arrival = std::max(arrival, again);
  }
  if (keep_order) {
    arrival = std::max(arrival, channel.last);
    channel.last = arrival;
  }
  Arrivals arrivals;
  arrivals.first = arrival;
  if (twice) arrivals.again = arrival + SimulatedTime(dice_.pick(k_late_us));
  return arrivals;
}

void SimulatedWires::cut(std::uint32_t host, SimulatedTime until) {
  Cut& cut = cuts_[host];
  const std::uint64_t direction = dice_.pick(3);
  if (direction != 0) cut.sends_again = until;
  if (direction != 1) cut.hears_again = until;
  cut.loses = dice_.chance(0.5);
}

}  // namespace meshfarm
