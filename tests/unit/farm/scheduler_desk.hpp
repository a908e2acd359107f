// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <meshfarm/farm/scheduler.hpp>

#include "support/jobs.hpp"

namespace meshfarm::test {

inline JobOutput output_of(JobKey key) {
  return {{to_string(ResultName{key.value, 1, 1}), 1, 1}, "made"};
}

/// A plan with a scheduler, and shorthands.
struct ScheduleDesk {
  explicit ScheduleDesk(std::vector<Job> jobs, const SchedulerOptions& options = {})
      : ScheduleDesk(std::vector<std::vector<Job>>{std::move(jobs)}, options) {}
  explicit ScheduleDesk(const std::vector<std::vector<Job>>& stages,
                        const SchedulerOptions& options = {})
      : plan(in_stages(stages), 3), scheduler(options) {
    plan.restart({});
  }
  void join(std::uint32_t id, const std::string& host, const Capacity& capacity = {},
            std::uint64_t room = 9) {
    scheduler.join({id}, host, capacity);
    scheduler.set_room({id}, room);
  }
  /// Everything that can be handed out now, each as "name@worker ".
  std::string hand_out() {
    std::string names;
    while (const auto pick = scheduler.next(plan, now)) {
      names += pick->job.job.parameters + "@" + std::to_string(pick->worker.value) + " ";
    }
    return names;
  }
  std::string second_attempts() {
    now += FarmTime(100);  // the scheduler looks for second attempts every 100 ms
    std::string names;
    for (const auto& pick : scheduler.second_attempts(plan, now)) {
      names += pick.job.job.parameters + "@" + std::to_string(pick.worker.value) + " ";
    }
    return names;
  }
  void fail(std::uint32_t id, const std::string& name) {
    const JobKey key = key_of(make_job(name));
    scheduler.failed({id}, now);
    scheduler.avoid({id}, key);
    scheduler.drop({id}, key, now);
    scheduler.set_room({id}, 1);
    plan.fail_attempt(key, "no luck", Failing::attempt);
  }
  void done(std::uint32_t id, const std::string& name) {
    const JobKey key = key_of(make_job(name));
    scheduler.did({id}, key, 1, now);
    scheduler.drop({id}, key, now);
    scheduler.settled(key);
    plan.accept(key, output_of(key));
  }

  Plan plan;
  Scheduler scheduler;
  FarmTime now{0};
};

inline Job with_memory(const std::string& name, std::uint64_t cost, std::uint64_t memory) {
  Job job = make_job(name, cost);
  job.memory = memory;
  return job;
}

}  // namespace meshfarm::test
