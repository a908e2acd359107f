// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/rounds.hpp>

namespace meshfarm {

enum class JobState : std::uint8_t { ready, running, done, failed };

/// A job as it is given out.
struct IssuedJob {
  JobKey key;
  std::uint32_t attempt = 0;
  Job job;
};

/// A job that was given up, and why each attempt failed.
struct LostJob {
  JobKey key;
  std::string kind;
  std::string reasons;
};

/// One line that tells of jobs given up: how many, and the reasons of the first few.
std::string failed_for_good(std::span<const std::string> reasons);

struct PlanCounts {
  std::uint64_t ready = 0;
  std::uint64_t running = 0;
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
  std::uint64_t cost_done = 0;
  std::uint64_t cost_known = 0;
  std::uint32_t retries = 0;
};

/// Which jobs there are and how far each is. Knows neither workers nor time.
/// A job is in exactly one state; only accept() makes it done.
class Plan {
 public:
  /// A job that failed `max_attempts` times is given up.
  Plan(JobSource source, std::uint32_t max_attempts)
      : source_(std::move(source)), rounds_(source_), max_attempts_(max_attempts) {}

  /// Begins (again) from what the sink has: the jobs accepted are exactly these, whatever was
  /// accepted before. Jobs that run go on running; attempts and failures are remembered.
  void restart(const std::map<JobKey, JobOutput>& accepted);
  bool started() const { return started_; }

  /// The ready job of the largest cost becomes running, under an attempt number of its own.
  std::optional<IssuedJob> issue();
  /// A running job that nobody will do (its worker left before it began) is ready again.
  void give_back(JobKey key);
  /// An attempt at a running job failed: it is ready again, or given up. `for_good` gives it up
  /// whatever its state, unless it is done.
  void fail_attempt(JobKey key, const std::string& reason, bool for_good);
  /// Takes a failure back that turned out to be none; a job given up for it is ready again.
  void forgive(JobKey key, const std::string& reason);
  /// False if the job is not wanted or done already.
  bool accept(JobKey key, const JobOutput& output);

  /// Nothing; if the job was never wanted.
  std::optional<JobState> state(JobKey key) const;
  /// How often the job was issued.
  std::uint32_t attempts(JobKey key) const;
  /// All jobs of all rounds are done.
  bool complete() const { return started_ && rounds_.complete(); }
  /// Nothing is left to do although some jobs were given up: the run cannot be completed.
  bool stuck() const;
  /// The jobs given up, in the order in which they were asked for.
  std::vector<LostJob> lost() const;
  const PlanCounts& counts() const { return counts_; }

 private:
  struct Entry {
    Job job;
    std::uint64_t order = 0;
    JobState state = JobState::ready;
    bool wanted = false;  // by the rounds reached since the last restart
    std::uint32_t attempts = 0;
    std::vector<std::string> failures;
  };
  struct ReadyJob {
    std::uint64_t cost = 0;
    std::uint64_t order = 0;
    JobKey key;
    bool operator<(const ReadyJob& other) const;
  };

  void advance(const std::map<JobKey, JobOutput>& accepted);
  void move_to(JobKey key, Entry& entry, JobState state);
  std::uint64_t& count_of(JobState state);

  JobSource source_;
  Rounds rounds_;
  std::uint32_t max_attempts_;
  bool started_ = false;
  std::uint64_t next_order_ = 0;
  std::unordered_map<JobKey, Entry, JobKeyHash> entries_;  // for look-up, never iterated
  std::vector<JobKey> wanted_;                             // in the order asked for
  std::set<ReadyJob> ready_;
  PlanCounts counts_;
};

}  // namespace meshfarm
