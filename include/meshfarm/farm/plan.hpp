// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>

namespace meshfarm {

enum class JobState : std::uint8_t { ready, running, done, failed };

/// A job as issued.
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
  bool resumable = false;  // given up only because workers were lost or results were unreadable
};

/// A host of the farm; 0: none.
using HostNumber = std::uint32_t;

/// Which of the ready jobs are eligible.
struct JobChoice {
  std::uint64_t max_cost = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t max_memory = std::numeric_limits<std::uint64_t>::max();
  std::function<bool(JobKey)> may = {};  // empty: any
  HostNumber host = 0;  // jobs at home on this host are preferred; 0: no preference

  bool takes(JobKey key, std::uint64_t cost, std::uint64_t memory) const {
    return cost <= max_cost && memory <= max_memory && (!may || may(key));
  }
};

/// What a failed attempt says about its job. worker_lost: the job was in work when its worker was
/// lost. unread: nothing, since the sink could not read the result.
enum class Failing { attempt, for_good, worker_lost, unread };

/// One line about jobs given up: how many, and the first few reasons.
std::string failed_for_good(std::span<const std::string> reasons);

struct PlanCounts {
  std::uint64_t ready = 0;
  std::uint64_t running = 0;
  std::uint64_t at_sink = 0;  // of the running jobs: done by the sink
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
  std::uint64_t cost_done = 0;
  std::uint64_t cost_known = 0;
  std::uint64_t cost_ready = 0;
  std::uint32_t retries = 0;
};

/// The jobs of a run and the state of each. Knows neither workers nor time. A job is in exactly one
/// state; only accept() makes it done. A job of the sink runs as soon as it is wanted, and is never
/// issued.
class Plan {
 public:
  /// A job that failed `max_attempts` times is given up.
  Plan(JobSource source, std::uint32_t max_attempts)
      : source_(std::move(source)), graph_(source_()), max_attempts_(max_attempts) {}

  /// Starts (again) from the sink's state: exactly these jobs are accepted, whatever was accepted
  /// before. Running jobs go on running; attempts and failures are remembered.
  void restart(const std::map<JobKey, JobOutput>& accepted);
  bool started() const { return started_; }

  /// Among the eligible ready jobs, issues the one with the longest path to the end (its own cost
  /// plus what follows); it becomes running under a new attempt number. (If very many are not
  /// eligible: the first eligible one whose path is no longer than the maximum cost, or one of
  /// those that need the most memory.) If that job is not at home on `choice.host`, a job of about
  /// the same path length that is at home there is preferred, or else one that has no home.
  std::optional<IssuedJob> issue(const JobChoice& choice = {});
  /// Issues this job, which is ready; or one more attempt at it if it is running.
  IssuedJob issue(JobKey key);
  /// Jobs that read the extent are now at home on this host, which has read it.
  void set_home(std::uint64_t extent, HostNumber host);
  /// The host that has read an extent, as far as is known.
  HostNumber home(std::uint64_t extent) const;
  /// An attempt that nobody makes any more (its worker left before it began). A running job is
  /// ready again after its last attempt is given back.
  void give_back(JobKey key);
  /// An attempt at a running job failed. Once no attempt is live the job is ready again; after
  /// `max_attempts` failures it is given up. for_good gives it up in any state except done.
  void fail_attempt(JobKey key, const std::string& reason, Failing failing);
  /// Takes back a failure that turned out to be none; a job given up because of it is ready again.
  void forgive(JobKey key, const std::string& reason);
  /// Whether it is a job of the run, as far as the run has come since the last restart.
  bool wants(JobKey key) const { return entries_.contains(key) && entries_.at(key).wanted; }
  /// False if the job is not wanted or already done.
  bool accept(JobKey key, const JobOutput& output);

  /// Nothing if the job was never wanted.
  std::optional<JobState> state(JobKey key) const;
  /// A known job.
  const Job& job(JobKey key) const { return entries_.at(key).job; }
  /// The place of a known job in the run.
  JobPlace place(JobKey key) const { return graph_.place(entries_.at(key).name); }
  /// Ordered by longest path to the end.
  std::vector<JobKey> ready_jobs() const;
  /// How many ready jobs need more than this much memory.
  std::uint64_t ready_above(std::uint64_t memory) const;
  /// The largest memory need of any ready job.
  std::uint64_t greatest_memory_ready() const {
    return by_memory_.empty() ? 0 : by_memory_.rbegin()->first;
  }
  /// How often the job was issued.
  std::uint32_t attempts(JobKey key) const;
  /// All jobs of the run are done.
  bool complete() const { return started_ && graph_.complete(); }
  /// Nothing is left to do, but some jobs were given up: the run cannot be completed.
  bool stuck() const;
  /// The jobs given up, in the order in which they became wanted.
  std::vector<LostJob> lost() const;
  /// A job that was given up.
  LostJob lost(JobKey key) const;
  const PlanCounts& counts() const { return counts_; }
  /// The progress of each stage of the run.
  std::vector<StageProgress> stages() const { return graph_.progress(); }

 private:
  struct Entry {
    Job job;
    std::uint64_t order = 0;
    JobName name;
    JobState state = JobState::ready;
    bool wanted = false;  // as far as the run has come since the last restart
    std::uint32_t attempts = 0;
    std::uint32_t live = 0;  // attempts that are being made
    std::vector<std::string> failures;
    bool resumable = false;
  };
  struct ReadyJob {
    std::uint64_t path = 0;  // the job's cost plus what follows it
    std::uint64_t order = 0;
    JobKey key = {};
    std::uint64_t cost = 0;
    std::uint64_t memory = 0;
    std::uint64_t extent = 0;
    bool operator<(const ReadyJob& other) const;
  };

  void want(std::vector<WantedJob> jobs, const std::map<JobKey, JobOutput>& accepted);
  void add_ready(JobKey key, const Entry& entry);
  void remove_ready(JobKey key, const Entry& entry);
  static ReadyJob ready_job(JobKey key, const Entry& entry);
  const ReadyJob* choose(const JobChoice& choice) const;
  const ReadyJob* longest_way(const JobChoice& choice) const;
  const ReadyJob* at_home(HostNumber host, const ReadyJob& best, const JobChoice& choice) const;
  void move_to(JobKey key, Entry& entry, JobState state);
  std::uint64_t& count_of(JobState state);
  void count(const Entry& entry, JobState state);
  void count_no_more(const Entry& entry);

  JobSource source_;
  JobGraph graph_;
  std::uint32_t max_attempts_;
  bool started_ = false;
  std::uint64_t next_order_ = 0;
  std::unordered_map<JobKey, Entry, JobKeyHash> entries_;  // for look-up, never iterated
  std::vector<JobKey> wanted_;  // in the order in which they became wanted
  std::set<ReadyJob> ready_;
  std::set<std::pair<std::uint64_t, ReadyJob>> by_memory_;  // ready jobs with a known memory need
  std::unordered_map<HostNumber, std::set<ReadyJob>> by_home_;  // ready jobs
  std::set<std::pair<std::uint64_t, JobKey>> by_extent_;        // ready jobs that have an extent
  std::unordered_map<std::uint64_t, HostNumber> homes_;         // by extent
  PlanCounts counts_;
};

}  // namespace meshfarm
