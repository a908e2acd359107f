// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <meshfarm/farm/dispatcher_actions.hpp>
#include <meshfarm/farm/farm_event.hpp>
#include <meshfarm/farm/farm_progress.hpp>
#include <meshfarm/farm/plan.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/scheduler.hpp>
#include <meshfarm/farm/when_full.hpp>

namespace meshfarm {

struct DispatcherOptions {
  std::uint64_t run = 0;
  std::uint32_t epoch = 0;
  FarmTime heartbeat{1000};
  /// A job hangs if it makes no progress for this long, and for three times its estimate.
  FarmTime hang{30'000};
  SchedulerOptions schedule = {};
  /// How long jobs that are larger than any worker's memory wait for a larger worker, once nothing
  /// else is left to do.
  FarmTime wait_for_memory{60'000};
  /// When the stage has no room: wait until it has, or end the run.
  WhenFull when_full = WhenFull::wait;
  bool tell = false;  // emit Tell actions for what happens
  std::uint32_t algorithm = 0;
};

/// The ventilator's decisions: it tracks who is there and who holds what; the Scheduler decides who
/// gets what. Pure: it takes messages and the time and returns the actions to take, in order; the
/// simulator runs the same class. Invariants: a worker is never sent a job beyond its credit or its
/// memory, and at most two workers hold a job.
class Dispatcher {
 public:
  Dispatcher(Plan plan, DispatcherOptions options)
      : plan_(std::move(plan)), options_(options), scheduler_(options.schedule) {}

  Actions on_message(const PeerId& peer, const Message& message, FarmTime now);
  Actions lane_opened(WorkerId id, const std::string& address);
  Actions lane_failed(WorkerId id, const std::string& reason);
  /// Whether all available messages have been delivered.
  enum class Inbox { empty, unread };
  /// Call about twice per heartbeat. With unread messages in the inbox, nobody is treated as
  /// silent.
  Actions tick(FarmTime now, Inbox inbox = Inbox::empty);
  /// Answers ProbeStage; `problem` is empty if the bytes could be written.
  Actions probed(const std::string& problem, FarmTime now);
  /// Tells everybody that this ventilator leaves before the run is over.
  Actions leave();
  /// Ends a run that turned out to be already complete.
  Actions end_complete();

  const Plan& plan() const { return plan_; }
  const Scheduler& scheduler() const { return scheduler_; }
  FarmProgress progress() const;
  std::vector<WorkerStatus> workers() const;
  /// Number of jobs that workers hold.
  std::uint64_t holding() const { return scheduler_.jobs_held(); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Worker {
    PeerId peer;
    std::uint64_t incarnation = 0;
    std::uint32_t pid = 0;
    std::string host;
    Capacity capacity;
    std::string lane;  // empty until the lane is open
    FarmTime heard{0};
    FarmTime pushed{0};
    std::uint64_t credit = 0;
    std::uint64_t sent = 0;
    int unreceived_beats = 0;  // consecutive heartbeats that report jobs sent but not received
    Heartbeat beat;            // the latest

    /// Whether it has sent a message that only a welcomed worker sends.
    bool knows_of_lane() const { return credit > 0 || beat.epoch != 0; }
  };
  struct Sink {
    PeerId peer;
    std::uint64_t incarnation = 0;
    std::string results;
    std::string host;
    FarmTime heard{0};
    bool ready = false;
    std::map<JobKey, JobOutput> told;
    std::uint64_t unverified = 0;  // of the results it accepted
    bool no_room = false;          // for its own writes
  };
  /// The stage is full: nobody is blamed, and no jobs are issued until a probe has been written.
  struct FullStage {
    FarmTime next_probe{0};
    FarmTime pause{0};  // between probes
    bool probing = false;
  };
  /// A result that the sink cannot read, or reads damaged. Before the worker's host is blamed, a
  /// worker on another host tries to read it.
  struct Doubt {
    Reject reject;
    WorkerId reader;
    FarmTime since{0};
    bool whole = false;  // as the reader reports
  };
  /// A host that could not read a job's inputs, and when.
  struct Unread {
    std::string host;
    FarmTime at{0};
  };
  /// A job that is blamed for the loss of a worker.
  struct Charge {
    JobKey key;
    std::string reason;
  };

  template <class M>
  void on(const PeerId&, const M&) {
    ++dropped_;
  }  // not for the ventilator
  void on(const PeerId& peer, const Hello& hello);
  void on(const PeerId& peer, const Heartbeat& beat);
  void on(const PeerId& peer, const Credit& credit);
  void on(const PeerId& peer, const Release& release);
  void on(const PeerId& peer, const Accept& accept);
  void on(const PeerId& peer, const Reject& reject);
  void on(const PeerId& peer, const Ready& ready);
  void on(const PeerId& peer, const Complete& complete);
  void on(const PeerId& peer, const Failed& failed);
  void on(const PeerId& peer, const TriedRead& tried);

  void worker_joins(const PeerId& peer, const Hello& hello);
  void move_to(const PeerId& peer, WorkerId id, Worker& worker);
  void sink_joins(const PeerId& peer, const Hello& hello);
  void welcome(WorkerId id, const Worker& worker);
  Worker* worker_at(const PeerId& peer, WorkerId id, std::uint32_t epoch);
  bool from_sink(const PeerId& peer, std::uint32_t epoch);
  void hear(WorkerId id, Worker& worker);
  bool holds(WorkerId id, JobKey key, std::uint32_t attempt) const;
  bool hangs(WorkerId id, const Worker& worker) const;
  bool storage_stalls() const;
  void lose_hanging(WorkerId id);
  void lose(WorkerId id, const std::string& reason, const std::vector<JobKey>& suspects);
  std::vector<JobKey> in_work(WorkerId id) const;
  std::optional<JobKey> the_one_to_blame(const std::vector<JobKey>& suspects) const;
  void lose_sink();
  std::uint32_t attempt_number(std::uint32_t attempt) const;
  void settle(JobKey key, WorkerId reporter);
  void restart_plan();
  void drop(WorkerId holder, JobKey key);
  enum class Blame { host, nobody, host_if_others_can };
  void reject_attempt(const Reject& reject, Blame blame);
  bool doubt(const Reject& reject);
  std::optional<WorkerId> second_reader(const Worker& reporter) const;
  void look_at_doubts();
  void blame_who_could_not_read(const Accept& accept);
  void fail(JobKey key, const std::string& reason, Failing failing);
  void set_room(WorkerId id);
  void stage_is_full(const Reject& reject);
  void look_for_room();
  bool may_issue() const;
  void issue();
  void push(Scheduler::Pick pick);
  void look_for_end();
  void look_for_memory();
  std::vector<std::string> reasons_of_lost() const;
  void finish(const std::string& failure, bool resumable);
  void to_workers(const Message& message);
  void tell(FarmEvent event) {
    if (options_.tell) out_.push_back(Tell{std::move(event)});
  }
  void send(const PeerId& peer, Message message) {
    out_.push_back(SendTo{peer, std::move(message)});
  }
  Actions take() { return std::exchange(out_, {}); }

  Plan plan_;
  DispatcherOptions options_;
  Scheduler scheduler_;
  FarmTime now_{0};
  Actions out_;
  std::uint32_t next_worker_ = 1;
  std::map<WorkerId, Worker> workers_;
  std::unordered_map<PeerId, WorkerId> by_peer_;
  std::unordered_map<std::uint64_t, WorkerId> by_incarnation_;
  std::set<std::pair<FarmTime, WorkerId>> by_heard_;
  std::unordered_map<std::uint64_t, Charge> charges_;         // by incarnation of the lost worker
  std::map<std::pair<JobKey, std::uint32_t>, Doubt> doubts_;  // by attempt
  std::map<JobKey, std::vector<Unread>> unread_on_;
  std::optional<Sink> sink_;
  std::uint64_t last_sink_ = 0;  // incarnation
  std::set<std::uint64_t> replaced_sinks_;
  std::optional<FarmTime> too_large_since_;
  std::optional<FullStage> full_;
  std::uint32_t relapses_ = 0;         // full again, with no result accepted since there was room
  std::uint64_t greatest_output_ = 0;  // of any result, in bytes
  bool over_ = false;
  bool finished_ = false;
  std::uint64_t dropped_ = 0;
  std::uint32_t lost_workers_ = 0;
  std::string other_build_;  // refused last
};

}  // namespace meshfarm
