// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The scheduler's fixed schedule: the work is dealt out in sets, one per worker.
#include <algorithm>

#include <meshfarm/farm/scheduler.hpp>

namespace meshfarm {

/// Deals out all jobs not dealt yet: the largest first, each to the worker that would finish it
/// earliest.
void Scheduler::deal(const Plan& plan) {
  std::map<WorkerId, double> load;
  for (const auto& [id, member] : crew_) {
    double cost = member.cost_held;
    for (const JobKey key : sets_[id]) cost += static_cast<double>(plan.job(key).cost);
    load[id] = cost;
  }
  undealt_.clear();
  for (const JobKey key : plan.ready_jobs()) {
    if (dealt_.contains(key)) continue;
    const Job& job = plan.job(key);
    const auto cost = static_cast<double>(job.cost);
    std::optional<std::pair<double, WorkerId>> best;
    for (const auto& [id, member] : crew_) {
      if (member.memory != 0 && job.memory > member.memory) continue;
      if (!serves(member) || !may_on_host(member, key, job.memory)) continue;
      const std::pair through((load[id] + cost) / (member.benchmark * member.threads), id);
      if (!best || through < *best) best = through;
    }
    if (!best) {
      undealt_.push_back(key);
      continue;
    }
    load[best->second] += cost;
    sets_[best->second].push_back(key);
    dealt_[key] = best->second;
  }
}

void Scheduler::deal_again() {
  for (auto& [id, set] : sets_) set.clear();
  dealt_.clear();
  undealt_.clear();
}

/// Jobs dealt to workers that may no longer be given them are dealt again.
void Scheduler::take_back(const Plan& plan) {
  const bool any_bad = next_ban_end_ != FarmTime::max();
  for (auto at = sets_.begin(); any_bad && at != sets_.end(); ++at) {
    if (serves(crew_.at(at->first))) continue;
    for (const JobKey key : at->second) dealt_.erase(key);
    at->second.clear();
  }
  for (const auto& [key, hosts] : failed_on_) {
    const auto dealt = dealt_.find(key);
    if (dealt == dealt_.end()) continue;
    if (may_on_host(crew_.at(dealt->second), key, plan.job(key).memory)) continue;
    std::erase(sets_.at(dealt->second), key);
    dealt_.erase(dealt);
  }
}

/// Takes a job from the worker's set that it may be given now.
std::optional<JobKey> Scheduler::next_of_set(WorkerId id, const Plan& plan) {
  const Member& member = crew_.at(id);
  std::deque<JobKey>& set = sets_[id];
  for (auto at = set.begin(); at != set.end();) {
    const JobKey key = *at;
    const bool ready = plan.state(key) == JobState::ready;
    if (ready && !fits(member, plan.job(key).memory)) break;  // until the others of its host rest
    if (ready && has_other_suspect(member, key)) {
      ++at;
      continue;
    }
    at = set.erase(at);
    dealt_.erase(key);
    if (ready) return key;
  }
  return std::nullopt;
}

std::optional<Scheduler::Pick> Scheduler::next_fixed(Plan& plan, FarmTime now) {
  if (crew_.size() < options_.expect_workers && sets_.empty()) return std::nullopt;
  take_back(plan);
  // Another run may have done jobs that fit no worker here.
  std::erase_if(undealt_, [&](JobKey key) { return plan.state(key) != JobState::ready; });
  if (plan.counts().ready > dealt_.size() + undealt_.size()) deal(plan);
  for (const auto& [load, id] : willing_) {
    if (const auto key = next_of_set(id, plan)) return hand(plan, id, plan.issue(*key), now);
  }
  return std::nullopt;
}

}  // namespace meshfarm
