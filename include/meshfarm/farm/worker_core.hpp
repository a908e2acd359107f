// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <meshfarm/farm/membership.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/worker_actions.hpp>
#include <meshfarm/farm/worker_report.hpp>

namespace meshfarm {

struct WorkerLimits {
  std::uint32_t buffer = 16;  // jobs that may wait, in addition to those in work
  std::uint32_t slots = 1;    // jobs in work concurrently: computed, read ahead, or written
  /// Bytes for all jobs in work together, 0: no limit. Other workers of the host may share it: the
  /// ventilator says how much of it is ours.
  std::uint64_t memory = 0;
  FarmTime grace{5000};  // for jobs in work to give up when the worker leaves
};
/// Limits of a worker with this capacity. One more job is in work than is computed: meanwhile its
/// inputs are read ahead, or its output is written.
WorkerLimits limits_of(const Capacity& capacity, std::uint32_t buffer);

/// Of jobs with at least this many bytes of input, no more are read concurrently than are computed.
/// A worker that waits for storage then starts computing as soon as it can, before it reads the
/// next.
inline constexpr std::uint64_t k_much_input = std::uint64_t{1} << 20;

/// What the job in a slot is doing.
enum class JobPhase : std::uint8_t { storage, waiting, computing };
struct SlotPulse {
  std::uint64_t progress = 0;  // any count that grows while the job makes progress
  JobPhase phase = JobPhase::computing;
  std::uint64_t cpu_ms = 0;  // processor time of the slot's thread; 0: unknown
};
/// Signs of life of all slots, including empty ones.
struct WorkerPulse {
  std::vector<SlotPulse> slots;  // empty: unknown, and no slot is treated as stalled
  std::uint64_t rss_bytes = 0;
  std::uint64_t progress() const;  // sum over all slots
};

/// The worker's decisions: its input buffer, its credit, and the results that nobody has
/// acknowledged yet. Pure. Invariants: it holds at most as many jobs as there are slots and buffer
/// places (more wait in the buffer when memory keeps slots empty); a result is kept until Done.
class WorkerCore {
 public:
  WorkerCore(MemberOptions member, const WorkerLimits& limits)
      : member_(std::move(member)), limits_(limits), slots_(limits.slots) {}

  WorkerActions tick(const WorkerPulse& pulse, FarmTime now);
  WorkerActions found(std::span<const Endpoint> endpoints, FarmTime now);
  WorkerActions on_control(const Message& message, FarmTime now);
  WorkerActions on_lane(const Message& message, FarmTime now);
  WorkerActions finished(std::uint32_t slot, std::variant<JobOutput, JobFailure> outcome,
                         FarmTime now, const JobTimes& times = {});
  /// Answers ReadForSink.
  WorkerActions tried(const TryRead& what, bool whole);
  /// Gives back everything held and leaves: at once, or when the jobs in work have ended.
  WorkerActions stop();

  const WorkerReport& report() const { return report_; }
  std::size_t waiting() const { return waiting_.size(); }
  std::size_t unacknowledged() const { return unacknowledged_.size(); }
  /// The longest wait for messages before tick() must be called again.
  FarmTime pause(FarmTime now) const { return member_.pause(now); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct InWork {
    JobKey key;
    std::uint32_t attempt = 0;
    std::uint64_t memory = 0;
    bool on_this_lane = true;  // counts against the lane's credit
    bool wanted = true;
    SlotPulse pulse = {};
    FarmTime moved{0};               // when the pulse last changed
    std::uint64_t moved_cpu_ms = 0;  // ...and the processor time at that moment

    /// How long it has made no progress. A job that computes on a busy host is judged by the
    /// processor time it got.
    FarmTime still(FarmTime now) const;
  };
  struct Waiting {
    JobKey key;
    Assignment assignment;
  };
  struct Kept {
    Result result;
    FarmTime sent{0};
  };

  void on(Membership::Event event, FarmTime now);
  void join(FarmTime now);
  void leave(std::string incomplete);
  void abort(std::string incomplete);
  void forget(const Done& done);
  void may_take(std::uint64_t memory);
  void sink_is_at(const std::string& address, FarmTime now);
  void send_result(Kept& kept, FarmTime now);
  void begin_next();
  std::optional<std::uint32_t> free_slot(std::uint64_t memory) const;
  void give_up(std::uint32_t slot);
  void raise_credit();
  void beat(const WorkerPulse& pulse, FarmTime now);
  void feel(const WorkerPulse& pulse, FarmTime now);
  std::uint32_t in_work() const;
  template <class A>
  void act(A action) {
    out_.emplace_back(std::in_place_type<A>, std::move(action));
  }
  WorkerActions take();

  Membership member_;
  WorkerLimits limits_;
  std::uint64_t memory_share_ = 0;  // of limits_.memory
  WorkerActions out_;
  FarmTime now_{0};
  std::deque<Waiting> waiting_;
  std::vector<std::optional<InWork>> slots_;
  std::map<JobKey, Kept> unacknowledged_;
  std::string sink_;
  std::uint64_t run_ = 0;       // the run of the kept results and jobs
  std::uint64_t received_ = 0;  // last lane number received
  std::uint64_t credit_ = 0;
  bool leaving_ = false;
  std::optional<FarmTime> leaving_since_;
  bool left_ = false;
  std::string incomplete_;
  WorkerReport report_;
  std::uint64_t dropped_ = 0;
};

}  // namespace meshfarm
