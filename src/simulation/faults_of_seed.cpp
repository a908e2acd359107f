// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/faults_of_seed.hpp"

#include "simulation/dice.hpp"

namespace meshfarm {

SimulatedFaults faults_of_seed(std::uint64_t seed) {
  // Different numbers from those that the simulation itself draws from the same seed.
  Dice dice(seed ^ 0x5eed'0f'fa'0175);
  const auto draw = [&](double rare, double frequent) {
    const std::uint64_t level = dice.pick(4);
    return level == 3 ? frequent : level == 2 ? rare : 0;
  };
  SimulatedFaults faults;
  faults.lose = draw(0.0005, 0.01);
  faults.duplicate = draw(0.001, 0.02);
  faults.late = draw(0.0005, 0.005);
  faults.overtake = draw(0.01, 0.2);
  faults.crash_at_job = draw(0.001, 0.01);
  faults.fail = draw(0.001, 0.01);
  faults.hang = draw(0.0002, 0.002);
  faults.read_error = draw(0.0005, 0.005);
  faults.write_error = draw(0.0005, 0.005);
  faults.lost_answer = draw(0.001, 0.01);
  faults.damaged = draw(0.001, 0.01);
  faults.unseen = draw(0.0005, 0.005);
  faults.stale = draw(0.001, 0.01);
  faults.lane_fails = draw(0.01, 0.1);
  faults.worker_crashes = draw(0.05, 0.5);
  faults.worker_pauses = draw(0.05, 0.5);
  faults.host_cuts = draw(0.05, 0.5);
  faults.sink_crashes = draw(0.5, 3);
  faults.sink_pauses = draw(0.5, 3);
  faults.ventilator_crashes = draw(0.5, 3);
  faults.ventilator_pauses = draw(0.5, 3);
  faults.storage_stalls = draw(0.5, 2);
  faults.disk_fills = draw(0.25, 1);
  faults.journal_error = draw(0.0005, 0.005);
  faults.late_endpoint = draw(0.05, 0.5);
  faults.worker_leaves = draw(0.05, 0.5);
  faults.other_runs = draw(0.5, 4);
  if (dice.pick(8) == 0) {  // they take minutes each
    faults.sick_mounts = draw(0.01, 0.05);
    faults.sick_sink = draw(0.05, 0.2);
    faults.lost_parts = draw(0.0005, 0.002);
  }
  const std::uint64_t hopeless = dice.pick(16);
  if (hopeless == 0) faults.poison = "job 3";
  if (hopeless == 1) faults.bad = "job 3";
  faults.decay = draw(0.002, 0.05);
  return faults;
}

}  // namespace meshfarm
