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

/// Who gets which job. Knows what each worker can do, what it holds, and how fast it has been: the
/// benchmark at first, then more and more the jobs it did. Pure.
///
/// Buffers are filled so that all would drain at the same time (the paper, 3.2.2), and shrink with
/// the work that is left. Near the end a worker is given a job only if it will have done it about
/// when all is done; and whoever has nothing to do makes a second attempt at what would take
/// another longer. Where all jobs of a kind take longer than was thought, as the storage is busy,
/// that would only make it busier: a second attempt is thought to take as long as the others do.
///
/// Among jobs of about the same length a worker is given those that read what its host has read,
/// then those that read what no host has. Of workers that are equally idle and about as fast the
/// one gets a job whose host has read what it reads.
class Scheduler {
 public:
  struct Held {
    JobKey key;
    std::uint32_t attempt = 0;
    std::uint64_t cost = 0;
    std::uint64_t memory = 0;
    std::string kind;
    std::optional<FarmTime> since;  // when it was its turn, as far as we know
  };
  struct Pick {
    WorkerId worker;
    IssuedJob job;
  };

  explicit Scheduler(const SchedulerOptions& options) : options_(options) {}

  void join(WorkerId id, const std::string& host, const Capacity& capacity);
  /// Returns what it held, as it was sent. The first jobs, as many as in_work(), may have begun.
  std::vector<Held> leave(WorkerId id);
  /// How many more jobs the worker may be sent.
  void set_room(WorkerId id, std::uint64_t jobs);
  /// It does not hold the job any more. False if it did not.
  bool drop(WorkerId id, JobKey key, FarmTime now);
  /// It did the job that it holds in so much time (0: not known).
  void did(WorkerId id, JobKey key, std::uint32_t compute_ms, FarmTime now);

  /// Something failed on the worker's host. After three incidents in a row it gets no more jobs for
  /// some minutes, as long as there are other hosts. What fails within seconds is one incident.
  void failed(WorkerId id, FarmTime now);
  void host_failed(const std::string& name, FarmTime now);
  /// The job is not to be tried again on the worker's host, as long as there are others.
  void avoid(WorkerId id, JobKey key);
  /// A job in work when a worker was lost. From now on no other suspect is given to a worker beside
  /// it, so that the next loss tells whether it is to blame.
  void suspect(JobKey key) { suspects_.insert(key); }
  bool is_suspect(JobKey key) const { return suspects_.contains(key); }
  void settled(JobKey key);
  /// The plan was restarted: by the fixed schedule all that is ready is dealt out anew.
  void deal_again();

  /// What to send to whom now, if anything: the plan has issued it, and the worker holds it.
  std::optional<Pick> next(Plan& plan, FarmTime now);
  /// Second attempts that are worth making, issued and held as with next(). May be asked at any
  /// time, and answers now and then.
  std::vector<Pick> second_attempts(Plan& plan, FarmTime now);

  const std::vector<Held>& held(WorkerId id) const { return crew_.at(id).held; }
  /// How many of the jobs it holds may be in work: one is read ahead or written beside those
  /// computed.
  std::uint32_t in_work(WorkerId id) const { return crew_.at(id).threads + 1; }
  /// Triangles a second of one of its threads, as estimated now.
  double speed(WorkerId id) const { return crew_.at(id).speed; }
  /// Who makes an attempt at the job: two at most.
  std::vector<WorkerId> holders(JobKey key) const;
  std::uint64_t jobs_held() const { return holders_.size(); }
  /// What the worker's jobs may take together: what it has, or its even share where others of its
  /// host have the same. 0: no limit.
  std::uint64_t memory_share(WorkerId id) const;
  /// The greatest memory that any worker has; none: no limit. Nothing if there is no worker.
  std::optional<std::uint64_t> greatest_memory() const;
  /// Hosts that get no more jobs.
  std::vector<std::string> bad_hosts() const;
  bool known(WorkerId id) const { return crew_.contains(id); }

 private:
  struct Host {
    std::string name;
    HostNumber number = 0;  // from 1 on
    std::set<WorkerId> workers;
    std::multiset<std::uint64_t> memories;  // of its workers
    std::uint32_t failures = 0;             // incidents in a row
    FarmTime incident{0};                   // when the last one began
  };
  struct Member;
  /// Memory that several workers of a host have together. A job that is too large for an even share
  /// is done while the others have nothing to do.
  struct Pool {
    std::uint32_t workers = 0;
    std::uint32_t at_work = 0;          // those that hold jobs
    const Member* by_itself = nullptr;  // holds such a job: the others get nothing
  };
  struct Member {
    Host* host = nullptr;
    Pool* pool = nullptr;  // none: the memory is its own
    std::uint32_t threads = 1;
    std::uint64_t memory = 0;  // 0: no limit
    double benchmark = 0;      // triangles a second and thread
    double speed = 0;
    double expected_done = 0;  // seconds that any worker, at its benchmark, takes for what it did
    double seconds_done = 0;
    std::uint64_t room = 0;
    std::vector<Held> held;
    double cost_held = 0;
    std::optional<double> rank;  // in willing_
  };
  struct Late {
    double left = 0;  // seconds
    const Held* held = nullptr;
    double times = 1;            // so much longer do jobs of its kind take than was thought
    const Host* host = nullptr;  // of its holder
    double beyond = 0;           // seconds that it has taken longer than that
  };
  /// What the jobs of a kind took that are done, and what was thought.
  struct Pace {
    double took = 0;
    double thought = 0;
  };
  /// How the rest of the run looks from `now`: times in seconds from then on.
  struct Outlook {
    FarmTime valid_until{-1};
    FarmTime now{0};
    std::uint64_t cost_ready = 0;
    double all_done = 0;   // if the work could be shared out evenly
    double last_free = 0;  // when the worker that has the most is through
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
  std::map<std::string, Host> hosts_;                            // entries stay
  std::vector<const Host*> host_of_number_;                      // from 1 on
  std::map<std::pair<std::string, std::uint64_t>, Pool> pools_;  // by host and number; they stay
  std::set<std::pair<double, WorkerId>> willing_;  // those who read nothing ahead, then the others;
                                                   // the least laden first
  std::unordered_map<JobKey, std::vector<WorkerId>, JobKeyHash> holders_;
  std::unordered_set<JobKey, JobKeyHash> suspects_;
  std::unordered_map<JobKey, std::vector<std::string>, JobKeyHash> failed_on_;
  Outlook outlook_;
  FarmTime next_second_attempts_{0};
  FarmTime next_ban_end_ = FarmTime::max();
  // What all workers took, what took far too long cut short.
  double seconds_done_ = 0;
  double squares_done_ = 0;  // of the seconds of each job
  // By kind: in seconds, as thought by the workers' speeds; and in what a worker could have done by
  // its benchmark, beside what the jobs cost.
  std::map<std::string, Pace> paces_;
  std::map<std::string, Pace> benchmark_paces_;
  // A fixed schedule: who shall get what.
  std::map<WorkerId, std::deque<JobKey>> sets_;
  std::unordered_map<JobKey, WorkerId, JobKeyHash> dealt_;  // what the sets hold
  std::vector<JobKey> undealt_;                             // ready jobs that fit nobody
};

}  // namespace meshfarm
