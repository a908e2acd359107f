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
  bool resumable = false;  // only because workers were lost over it, or results not read
};

/// A host of the farm; 0: none.
using HostNumber = std::uint32_t;

/// Which of the ready jobs will do.
struct JobChoice {
  std::uint64_t max_cost = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t max_memory = std::numeric_limits<std::uint64_t>::max();
  std::function<bool(JobKey)> may = {};  // empty: any
  HostNumber host = 0;                   // jobs at home there are preferred; 0: none are

  bool takes(JobKey key, std::uint64_t cost, std::uint64_t memory) const {
    return cost <= max_cost && memory <= max_memory && (!may || may(key));
  }
};

/// What an attempt that failed says of its job. worker_lost: the worker was, and the job in work.
/// unread: nothing, its result could not be read by the sink.
enum class Failing { attempt, for_good, worker_lost, unread };

/// One line that tells of jobs given up: how many, and the reasons of the first few.
std::string failed_for_good(std::span<const std::string> reasons);

struct PlanCounts {
  std::uint64_t ready = 0;
  std::uint64_t running = 0;
  std::uint64_t at_sink = 0;  // of those that run: the sink does them
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
  std::uint64_t cost_done = 0;
  std::uint64_t cost_known = 0;
  std::uint64_t cost_ready = 0;
  std::uint32_t retries = 0;
};

/// Which jobs there are and how far each is. Knows neither workers nor time.
/// A job is in exactly one state; only accept() makes it done. A job of the sink runs as soon as it
/// is asked for, and is never issued.
class Plan {
 public:
  /// A job that failed `max_attempts` times is given up.
  Plan(JobSource source, std::uint32_t max_attempts)
      : source_(std::move(source)), graph_(source_()), max_attempts_(max_attempts) {}

  /// Begins (again) from what the sink has: the jobs accepted are exactly these, whatever was
  /// accepted before. Jobs that run go on running; attempts and failures are remembered.
  void restart(const std::map<JobKey, JobOutput>& accepted);
  bool started() const { return started_; }

  /// The ready job with the longest way to the end, its own cost and what follows, among those that
  /// will do becomes running, under an attempt number of its own. (Where very many do not, the
  /// first whose way is no longer than the greatest cost, or one of the most memory that does.)
  /// If it is at home on another host than the one that is asked for, a job of about the same
  /// length that is at home there goes before it, or else one that is at home nowhere.
  std::optional<IssuedJob> issue(const JobChoice& choice = {});
  /// This job, which is ready; or one more attempt at it if it is running.
  IssuedJob issue(JobKey key);
  /// From now on jobs that read the extent are at home on this host, which has read it.
  void set_home(std::uint64_t extent, HostNumber host);
  /// Which host has read an extent, as far as is known.
  HostNumber home(std::uint64_t extent) const;
  /// An attempt that nobody makes any more (its worker left before it began). A running job is
  /// ready again after the last.
  void give_back(JobKey key);
  /// An attempt at a running job failed: after the last it is ready again, or given up. for_good
  /// gives it up whatever its state, unless it is done.
  void fail_attempt(JobKey key, const std::string& reason, Failing failing);
  /// Takes a failure back that turned out to be none; a job given up for it is ready again.
  void forgive(JobKey key, const std::string& reason);
  /// Whether it is a job of the run as far as that has come since the last restart.
  bool wants(JobKey key) const { return entries_.contains(key) && entries_.at(key).wanted; }
  /// False if the job is not wanted or done already.
  bool accept(JobKey key, const JobOutput& output);

  /// Nothing; if the job was never wanted.
  std::optional<JobState> state(JobKey key) const;
  /// A job that is known.
  const Job& job(JobKey key) const { return entries_.at(key).job; }
  /// Where a job that is known stands in the run.
  JobPlace place(JobKey key) const { return graph_.place(entries_.at(key).name); }
  /// The longest way to the end first.
  std::vector<JobKey> ready_jobs() const;
  /// How many ready jobs need more memory than this.
  std::uint64_t ready_above(std::uint64_t memory) const;
  /// The most that any ready job needs.
  std::uint64_t greatest_memory_ready() const {
    return by_memory_.empty() ? 0 : by_memory_.rbegin()->first;
  }
  /// How often the job was issued.
  std::uint32_t attempts(JobKey key) const;
  /// All jobs of the run are done.
  bool complete() const { return started_ && graph_.complete(); }
  /// Nothing is left to do although some jobs were given up: the run cannot be completed.
  bool stuck() const;
  /// The jobs given up, in the order in which they were asked for.
  std::vector<LostJob> lost() const;
  /// One that was given up.
  LostJob lost(JobKey key) const;
  const PlanCounts& counts() const { return counts_; }
  /// How far each stage of the run is.
  std::vector<StageProgress> stages() const { return graph_.progress(); }

 private:
  struct Entry {
    Job job;
    std::uint64_t order = 0;
    JobName name;
    JobState state = JobState::ready;
    bool wanted = false;  // as far as the run has come since the last restart
    std::uint32_t attempts = 0;
    std::uint32_t live = 0;  // attempts that somebody makes
    std::vector<std::string> failures;
    bool resumable = false;
  };
  struct ReadyJob {
    std::uint64_t path = 0;  // the job's cost and what follows it
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
  std::vector<JobKey> wanted_;                             // in the order asked for
  std::set<ReadyJob> ready_;
  std::set<std::pair<std::uint64_t, ReadyJob>> by_memory_;  // the ready jobs that say their need
  std::unordered_map<HostNumber, std::set<ReadyJob>> by_home_;  // the ready jobs
  std::set<std::pair<std::uint64_t, JobKey>> by_extent_;        // the ready jobs that have one
  std::unordered_map<std::uint64_t, HostNumber> homes_;         // of extents
  PlanCounts counts_;
};

}  // namespace meshfarm
