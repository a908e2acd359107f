// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/farm/job_graph.hpp>

namespace meshfarm {

/// Checks a farm's invariants, and keeps the first violation.
class SimulationChecks {
 public:
  // Actions and messages of one epoch's ventilator.
  void epoch_begins();
  void credit(WorkerId worker, std::uint64_t up_to);
  void pushed(WorkerId worker, JobKey key, const Assignment& assignment);
  void welcomed(const PeerId& peer, WorkerId worker) { members_[peer] = worker; }
  void told_done(const PeerId& peer, JobKey key);
  void lane_closed(WorkerId worker);
  void plan(const Dispatcher& dispatcher);
  /// The same checks, job by job: slow.
  void whole_plan(const Plan& plan);

  void journalled(JobKey key, bool file_is_whole);
  /// A result that the sink no longer finds whole: it may be accepted again.
  void taken_back(JobKey key) { journalled_.erase(key); }
  void that(bool holds, const char* what) {
    if (!holds && broken_.empty()) broken_ = what;
  }
  const std::string& broken() const { return broken_; }

 private:
  struct Lane {
    std::uint64_t credit = 0;
    std::uint64_t sent = 0;
    std::vector<JobKey> held;
  };
  void ended(JobKey key);

  std::string broken_;
  std::unordered_map<std::uint32_t, Lane> lanes_;
  std::unordered_map<PeerId, WorkerId> members_;
  std::unordered_map<JobKey, int, JobKeyHash> live_;  // attempts that the ventilator counts on
  std::unordered_map<JobKey, std::uint32_t, JobKeyHash> last_attempt_;
  std::unordered_set<JobKey, JobKeyHash> journalled_;
};

}  // namespace meshfarm
