// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What workers and sinks have in common, as in src/transport/control_link.hpp.
#include <utility>

#include "simulation/simulated_farm.hpp"

namespace meshfarm {

void SimulatedFarm::start_member(Member& member) {
  member.alive = true;
  ++member.life;
  member.to_ventilator = member.from_ventilator = {};
  member.to_ventilator.from = member.from_ventilator.to = member.host;
}

void SimulatedFarm::end_member(Member& member) {
  kill(member);
  member.peer.clear();
}

/// Uses a new name each time, as the real process uses a new routing id. Addresses are "v" and the
/// epoch.
void SimulatedFarm::dial(Member& member, const std::string& name, const Dial& each) {
  member.peer = name + std::to_string(++dials_);
  member.dialled = static_cast<std::uint32_t>(std::stoul(each.address.substr(1)));
}

void SimulatedFarm::say(Member& member, Message message) {
  if (member.peer.empty()) return;
  // Messages that a killed process had not passed to the network are lost with it.
  const bool buffered = chance(0.5);
  const Run* known = run_at(member.dialled);
  member.to_ventilator.to = (known != nullptr ? *known : runs_.front()).ventilator.host;
  wires_.send(member.to_ventilator, SimulatedWires::Order::kept,
              [this, &member, buffered, life = member.life, peer = member.peer,
               epoch = member.dialled, letter = in_envelope(std::move(message))] {
                if (buffered && member.life != life) return;
                if (Run* run = run_at(epoch)) ventilator_gets(*run, peer, letter);
              });
}

}  // namespace meshfarm
