// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <meshfarm/farm/plan.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/schedule.hpp>

namespace meshfarm {

/// Decides who gets which job. Knows each worker's capacity, the jobs it holds, and its speed: from
/// the benchmark at first, then increasingly from the jobs it did. Pure.
///
/// Buffers are filled so that all would drain at the same time (the paper, 3.2.2), and shrink with
/// the remaining work. Near the end a worker gets a job only if it will finish it about when
/// everything is done; idle workers make second attempts at jobs that would take their holder
/// longer. When all jobs of a kind take longer than estimated because the storage is busy, second
/// attempts would only make it busier: a second attempt is assumed to take as long as the others
/// do.
///
/// Among jobs of about the same length, a worker gets those that read what its host has read, then
/// those that read what no host has. Among workers that are equally idle and about as fast, a job
/// goes to one whose host has read what the job reads.
class Scheduler {
 public:
  struct Held {
    JobKey key;
    std::uint32_t attempt = 0;
    std::uint64_t cost = 0;
    std::uint64_t memory = 0;
    std::string kind;
    std::optional<FarmTime> since;  // when its turn came, as far as is known
  };
  struct Pick {
    WorkerId worker;
    IssuedJob job;
  };

  explicit Scheduler(const SchedulerOptions& options) : options_(options) {}

  void join(WorkerId id, const std::string& host, const Capacity& capacity);
  /// Returns the jobs it held, in the order sent. The first in_work() of them may have begun.
  std::vector<Held> leave(WorkerId id);
  /// How many more jobs the worker may be sent.
  void set_room(WorkerId id, std::uint64_t jobs);
  /// The worker no longer holds the job. False if it did not hold it.
  bool drop(WorkerId id, JobKey key, FarmTime now);
  /// The worker did a job that it holds in this time (0: unknown).
  void did(WorkerId id, JobKey key, std::uint32_t compute_ms, FarmTime now);

  /// Something failed on the worker's host. After three incidents in a row the host gets no more
  /// jobs for some minutes, as long as there are other hosts. Failures within seconds of each other
  /// are one incident.
  void failed(WorkerId id, FarmTime now);
  void host_failed(const std::string& name, FarmTime now);
  /// Do not retry the job on the worker's host, as long as there are others.
  void avoid(WorkerId id, JobKey key);
  /// A job that was in work when a worker was lost. From now on no worker gets another suspect
  /// beside it, so that the next loss shows whether it is to blame.
  void suspect(JobKey key) { suspects_.insert(key); }
  bool is_suspect(JobKey key) const { return suspects_.contains(key); }
  void settled(JobKey key);
  /// The plan was restarted: a fixed schedule deals out all ready jobs again.
  void deal_again();

  /// The next job to send, and to whom, if any: the plan has issued it, and the worker holds it.
  std::optional<Pick> next(Plan& plan, FarmTime now);
  /// Second attempts that are worth making, issued and held as with next(). May be called at any
  /// time; returns some only now and then.
  std::vector<Pick> second_attempts(Plan& plan, FarmTime now);

  const std::vector<Held>& held(WorkerId id) const { return crew_.at(id).held; }
  /// How many of its held jobs may be in work: one is read ahead or written in addition to those
  /// being computed.
  std::uint32_t in_work(WorkerId id) const { return crew_.at(id).threads + 1; }
  /// Current estimate of triangles per second of one of its threads.
  double speed(WorkerId id) const { return crew_.at(id).speed; }
  /// The workers that make an attempt at the job: at most two.
  std::vector<WorkerId> holders(JobKey key) const;
  std::uint64_t jobs_held() const { return holders_.size(); }
  /// The memory that the worker's jobs may take together: its own, or its even share where others
  /// of its host report the same pool. 0: no limit.
  std::uint64_t memory_share(WorkerId id) const;
  /// The largest memory of any worker; no limit counts as the greatest number. Nothing if there is
  /// no worker.
  std::optional<std::uint64_t> greatest_memory() const;
  /// Hosts that get no more jobs.
  std::vector<std::string> bad_hosts() const;
  bool known(WorkerId id) const { return crew_.contains(id); }

 private:
  struct Host {
    std::string name;
    HostNumber number = 0;  // from 1
    std::set<WorkerId> workers;
    std::multiset<std::uint64_t> memories;  // of its workers
    std::uint32_t failures = 0;             // consecutive incidents
    FarmTime incident{0};                   // start of the last one
  };
  struct Member;
  /// Memory shared by several workers of a host. A job that is too large for an even share is done
  /// while the other workers are idle.
  struct Pool {
    std::uint32_t workers = 0;
    std::uint32_t at_work = 0;          // workers that hold jobs
    const Member* by_itself = nullptr;  // holds such a job: the others get nothing
  };
  struct Member {
    Host* host = nullptr;
    Pool* pool = nullptr;  // null: the memory is its own
    std::uint32_t threads = 1;
    std::uint64_t memory = 0;  // 0: no limit
    double benchmark = 0;      // triangles per second and thread
    double speed = 0;
    double expected_done = 0;  // seconds that any worker, at its benchmark, takes for the same jobs
    double seconds_done = 0;
    std::uint64_t room = 0;
    std::vector<Held> held;
    double cost_held = 0;
    std::optional<double> rank;  // in willing_
  };
  struct Late {
    double left = 0;  // seconds
    const Held* held = nullptr;
    double times = 1;            // how many times longer jobs of its kind take than estimated
    const Host* host = nullptr;  // the holder's
    double beyond = 0;           // seconds beyond that
  };
  /// Actual and estimated time of the completed jobs of a kind.
  struct Pace {
    double took = 0;
    double thought = 0;
  };
  /// The outlook for the rest of the run: times in seconds from `now`.
  struct Outlook {
    FarmTime valid_until{-1};
    FarmTime now{0};
    std::uint64_t cost_ready = 0;
    double all_done = 0;   // if the work could be shared evenly
    double last_free = 0;  // when the busiest worker is done
    double fastest = 0;
  };

  std::uint64_t share(const Member& member) const;
  std::uint64_t memory_now(const Member& member) const;
  bool fits(const Member& member, std::uint64_t memory) const;
  void pool_holds(Member& member, std::uint64_t memory);
  void pool_dropped(Member& member);
  void leave_pool(Member& member);
  bool good(const Host& host) const;
  void end_bans(FarmTime now);
  std::map<std::string, double> times_longer(FarmTime now) const;
  std::vector<Late> late_jobs(const Plan& plan, FarmTime now) const;
  bool elsewhere(const std::vector<std::string>& hosts, std::uint64_t memory = 0) const;
  bool may_on_host(const Member& member, JobKey key, std::uint64_t memory) const;
  bool has_other_suspect(const Member& member, JobKey key) const;
  bool may(const Member& member, JobKey key, std::uint64_t memory) const;
  void rank(WorkerId id, Member& member);
  void rank_all();
  void bans_changed();
  bool serves(const Member& member) const;
  bool open(const Member& member) const;
  void begin_turns(Member& member, FarmTime now);
  double estimated_speed(const Member& member) const;
  double seconds_left(const Member& member, const Held& held, FarmTime now, double times = 1) const;
  double seconds_held(const Member& member, FarmTime now) const;
  const Outlook& outlook(const Plan& plan, FarmTime now);
  std::uint64_t greatest_cost(const Member& member, FarmTime now) const;
  JobChoice choice_for(const Member& member, const Plan& plan, FarmTime now) const;
  WorkerId at_home(WorkerId id, const IssuedJob& job, const Plan& plan, FarmTime now) const;
  void find_home(Plan& plan, std::uint64_t extent, const Host& host) const;
  Pick hand(Plan& plan, WorkerId id, IssuedJob job, FarmTime now);
  std::optional<Pick> next_fixed(Plan& plan, FarmTime now);
  void deal(const Plan& plan);
  void take_back(const Plan& plan);
  std::optional<JobKey> next_of_set(WorkerId id, const Plan& plan);

  SchedulerOptions options_;
  std::map<WorkerId, Member> crew_;
  std::map<std::string, Host> hosts_;                            // entries are never removed
  std::vector<const Host*> host_of_number_;                      // from 1
  std::map<std::pair<std::string, std::uint64_t>, Pool> pools_;  // by host and number; they stay
  std::set<std::pair<double, WorkerId>> willing_;  // those who read nothing ahead, then the others;
                                                   // the least laden first
  std::unordered_map<JobKey, std::vector<WorkerId>, JobKeyHash> holders_;
  std::unordered_set<JobKey, JobKeyHash> suspects_;
  std::unordered_map<JobKey, std::vector<std::string>, JobKeyHash> failed_on_;
  Outlook outlook_;
  FarmTime next_second_attempts_{0};
  FarmTime next_ban_end_ = FarmTime::max();
  // Time taken by all workers; outliers are capped.
  double seconds_done_ = 0;
  double squares_done_ = 0;  // of each job's seconds
  // By kind: seconds, estimated from the workers' speeds; and what a worker could have done at its
  // benchmark speed, against what the jobs cost.
  std::map<std::string, Pace> paces_;
  std::map<std::string, Pace> benchmark_paces_;
  // Fixed schedule: the jobs of each worker.
  std::map<WorkerId, std::deque<JobKey>> sets_;
  std::unordered_map<JobKey, WorkerId, JobKeyHash> dealt_;  // all jobs in the sets
  std::vector<JobKey> undealt_;                             // ready jobs that no worker can take
};

}  // namespace meshfarm
