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
#include <meshfarm/farm/worker.hpp>

namespace meshfarm {

struct ConnectLane {
  std::string address;
};
/// Empty: there is no sink for now.
struct ConnectSink {
  std::string address;
};
struct SendResult {
  Result result;
};
/// Give the job to the compute thread, which has none; answered by finished().
struct Begin {
  std::uint32_t attempt = 0;
  Job job;
};
/// Ask the compute thread to give its job up; it still answers with finished().
struct GiveUp {};
/// The end; `incomplete` says why the run is not over.
struct Leave {
  std::string incomplete;
};
using WorkerAction = std::variant<Look, Dial, HangUp, Say, ConnectLane, ConnectSink, SendResult,
                                  Begin, GiveUp, Leave>;
using WorkerActions = std::vector<WorkerAction>;

/// The worker's mind: its input buffer, its credit, the results that nobody acknowledged yet. Pure.
/// Holds: at most `buffer` jobs wait beside the one in work; a result is kept until Done.
class WorkerCore {
 public:
  WorkerCore(MemberOptions member, std::uint32_t buffer)
      : member_(std::move(member)), buffer_(buffer) {}

  /// `progress` is the compute thread's counter.
  WorkerActions tick(std::uint64_t progress, FarmTime now);
  WorkerActions found(std::span<const Endpoint> endpoints, FarmTime now);
  WorkerActions on_control(const Message& message, FarmTime now);
  WorkerActions on_lane(const Message& message, FarmTime now);
  WorkerActions finished(std::variant<JobOutput, JobFailure> outcome, FarmTime now);
  /// Gives back all that is held and leaves, at once or when the job in work ended.
  WorkerActions stop();

  const WorkerReport& report() const { return report_; }
  std::size_t waiting() const { return waiting_.size(); }
  std::size_t unacknowledged() const { return unacknowledged_.size(); }
  FarmTime heartbeat() const { return member_.heartbeat(); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct InWork {
    JobKey key;
    std::uint32_t attempt = 0;
    bool on_this_lane = true;  // it counts against the lane's credit
    bool wanted = true;
  };
  struct Kept {
    Result result;
    FarmTime sent{0};
  };

  void on(Membership::Event event, FarmTime now);
  void join(FarmTime now);
  void leave(std::string incomplete);
  void forget(const Done& done);
  void sink_is_at(const std::string& address, FarmTime now);
  void send_result(Kept& kept, FarmTime now);
  void begin_next();
  void raise_credit();
  std::uint32_t held() const;
  template <class A>
  void act(A action) {
    out_.push_back(std::move(action));
  }
  WorkerActions take();

  Membership member_;
  std::uint32_t buffer_;
  WorkerActions out_;
  std::deque<Assignment> waiting_;
  std::optional<InWork> in_work_;
  std::map<JobKey, Kept> unacknowledged_;
  std::string sink_;
  std::uint64_t run_ = 0;       // that what is kept belongs to
  std::uint64_t received_ = 0;  // the lane's last number
  std::uint64_t credit_ = 0;
  bool leaving_ = false;
  bool left_ = false;
  std::string incomplete_;
  WorkerReport report_;
  std::uint64_t dropped_ = 0;
};

}  // namespace meshfarm
