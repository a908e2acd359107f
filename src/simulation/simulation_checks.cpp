// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/simulation_checks.hpp"

#include <algorithm>
#include <array>

namespace meshfarm {
namespace {

constexpr int k_most_live_attempts = 2;

}  // namespace

void SimulationChecks::epoch_begins() {
  lanes_.clear();
  members_.clear();
  live_.clear();
}

void SimulationChecks::credit(WorkerId worker, std::uint64_t up_to) {
  std::uint64_t& known = lanes_[worker.value].credit;
  known = std::max(known, up_to);
}

void SimulationChecks::pushed(WorkerId worker, JobKey key, const Assignment& assignment) {
  Lane& lane = lanes_[worker.value];
  that(assignment.lane_seq == ++lane.sent, "a lane skipped a number");
  that(assignment.lane_seq <= lane.credit, "a worker was sent more than its credit");
  that(std::find(lane.held.begin(), lane.held.end(), key) == lane.held.end(),
       "a worker was sent a job that it holds");
  lane.held.push_back(key);
  that(++live_[key] <= k_most_live_attempts, "a job has more than two live attempts");
  std::uint32_t& last = last_attempt_[key];
  that(assignment.attempt > last, "an attempt number was used again");
  last = assignment.attempt;
}

void SimulationChecks::told_done(const PeerId& peer, JobKey key) {
  const auto member = members_.find(peer);
  if (member == members_.end()) return;
  const auto lane = lanes_.find(member->second.value);
  if (lane != lanes_.end() && std::erase(lane->second.held, key) != 0) ended(key);
}

void SimulationChecks::lane_closed(WorkerId worker) {
  const auto lane = lanes_.find(worker.value);
  if (lane == lanes_.end()) return;
  for (const JobKey key : lane->second.held) ended(key);
  lanes_.erase(lane);
}

void SimulationChecks::ended(JobKey key) {
  const auto live = live_.find(key);
  if (live != live_.end() && --live->second == 0) live_.erase(live);
}

void SimulationChecks::plan(const Dispatcher& dispatcher) {
  // More are held than running only while a restarted plan does not want some of the held ones yet.
  const PlanCounts& counts = dispatcher.plan().counts();
  that(dispatcher.holding() + counts.at_sink >= counts.running, "a job runs that nobody holds");
  that(counts.cost_done <= counts.cost_known, "more is done than is known");
}

void SimulationChecks::whole_plan(const Plan& plan) {
  std::array<std::uint64_t, 4> states{};
  for (const auto& [key, attempt] : last_attempt_) {
    const auto state = plan.state(key);
    if (state) ++states[static_cast<std::size_t>(*state)];
  }
  const PlanCounts& counts = plan.counts();
  that(counts.running <= states[1] + counts.at_sink, "a job is counted as running and is not");
  that(counts.failed <= states[3], "a job is counted as failed and is not");
}

void SimulationChecks::journalled(JobKey key, bool file_is_whole) {
  that(journalled_.insert(key).second, "a job was accepted twice");
  that(file_is_whole, "a job was accepted whose file is not whole");
}

}  // namespace meshfarm
