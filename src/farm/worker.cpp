// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include <meshfarm/farm/worker.hpp>
#include <meshfarm/farm/worker_core.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "farm/control_link.hpp"
#include "farm/sockets.hpp"
#include "farm/task_thread.hpp"

namespace meshfarm {
namespace {

/// So that a flood cannot keep the clock from being looked at.
constexpr int k_messages_per_turn = 1000;

using Outcome = std::variant<JobOutput, JobFailure>;

/// The sockets and the compute thread round a WorkerCore, which decides everything.
class WorkerLoop {
 public:
  WorkerLoop(const Stage& stage, const JobFunction& work, const WorkerOptions& options)
      : stage_(stage),
        work_(work),
        options_(options),
        incarnation_(random_id()),
        context_(make_context()),
        link_(context_, stage),
        core_({Role::worker,
               0,
               incarnation_,
               static_cast<std::uint32_t>(::getpid()),
               clipped(host_name()),
               {},
               options.patience,
               options.capacity},
              options.buffer) {}

  WorkerReport run() {
    while (!left_) {
      if (options_.stop != nullptr && options_.stop->load()) perform(core_.stop());
      turn();
    }
    if (!left_->incomplete.empty()) throw IncompleteError(left_->incomplete);
    return core_.report();
  }

 private:
  void turn() {
    std::vector<zmq::pollitem_t> items = {{nullptr, compute_.fd(), ZMQ_POLLIN, 0}};
    if (link_.socket() != nullptr) items.push_back({link_.socket()->handle(), 0, ZMQ_POLLIN, 0});
    if (lane_) items.push_back({lane_->handle(), 0, ZMQ_POLLIN, 0});
    wait_for(items, poll_interval(core_.heartbeat()));
    const FarmTime now = farm_clock();
    if (compute_.take_finished()) perform(core_.finished(std::move(outcome_), now));
    for (int count = 0; link_.socket() != nullptr && count < k_messages_per_turn; ++count) {
      const auto received = receive(*link_.socket());
      if (!received) break;
      if (received->message) perform(core_.on_control(*received->message, now));
    }
    for (int count = 0; lane_ && count < k_messages_per_turn; ++count) {
      const auto received = receive(*lane_);
      if (!received) break;
      if (received->message) perform(core_.on_lane(*received->message, now));
    }
    perform(core_.tick(progress_.load(std::memory_order_relaxed), now));
  }

  void perform(const WorkerActions& actions) {
    for (const WorkerAction& action : actions) {
      std::visit([this](const auto& each) { act(each); }, action);
    }
  }

  void act(const Look&) { perform(core_.found(link_.look(), farm_clock())); }
  void act(const Dial& each) { link_.dial(each.address); }
  void act(const HangUp&) {
    link_.hang_up();
    lane_.reset();
  }
  void act(const Say& each) { link_.say(each.message); }
  void act(const ConnectLane& each) {
    lane_.emplace(make_lane_client(context_));
    connect(*lane_, each.address);
  }
  void act(const ConnectSink& each) {
    if (results_) results_->set(zmq::sockopt::linger, 0);
    results_.reset();
    if (each.address.empty()) return;
    results_.emplace(make_results_client(context_));
    connect(*results_, each.address);
  }
  void act(const SendResult& each) {
    if (results_) send(*results_, each.result);  // what gets lost is sent again
  }
  void act(const Begin& each) {
    give_up_.store(false);
    compute_.start([this, each] { outcome_ = attempt(each); });
  }
  void act(const GiveUp&) { give_up_.store(true); }
  void act(const Leave& each) { left_ = each; }

  static void connect(zmq::socket_t& socket, const std::string& address) {
    try {
      socket.connect(address);
    } catch (const zmq::error_t& error) {
      log_debug("cannot connect to '" + address + "': " + error.what());
    }
  }

  /// On the compute thread. Whatever the job's function throws is the job's failure, not ours.
  Outcome attempt(const Begin& begin) {
    const JobContext context{stage_, begin.attempt, incarnation_, [this](std::uint64_t done) {
                               progress_.fetch_add(done, std::memory_order_relaxed);
                               return !give_up_.load(std::memory_order_relaxed);
                             }};
    try {
      return checked(begin, work_(begin.job, context));
    } catch (const BadInputError& error) {
      return JobFailure{clipped(error.what()), FailureKind::for_good};
    } catch (const std::bad_alloc&) {
      return JobFailure{"out of memory", FailureKind::attempt};
    } catch (const std::exception& error) {
      return JobFailure{clipped(error.what()), FailureKind::attempt};
    } catch (...) {
      return JobFailure{"an unknown exception", FailureKind::attempt};
    }
  }

  Outcome checked(const Begin& begin, JobOutput output) const {
    const ResultName name{key_of(begin.job).value, begin.attempt, incarnation_};
    if (output.file.name != to_string(name)) {
      return JobFailure{
          clipped("its output is named '" + output.file.name + "', not '" + to_string(name) + "'"),
          FailureKind::attempt};
    }
    if (output.summary.size() > k_max_summary_bytes) {
      return JobFailure{"its summary is too long for a message", FailureKind::attempt};
    }
    return output;
  }

  const Stage& stage_;
  const JobFunction& work_;
  const WorkerOptions& options_;
  std::uint64_t incarnation_;
  zmq::context_t context_;
  ControlLink link_;
  std::optional<zmq::socket_t> lane_;
  std::optional<zmq::socket_t> results_;
  WorkerCore core_;
  std::optional<Leave> left_;
  std::atomic<std::uint64_t> progress_{0};
  std::atomic<bool> give_up_{false};
  Outcome outcome_;     // the compute thread's while it works
  TaskThread compute_;  // the last member, so that its thread ends first
};

}  // namespace

WorkerReport run_worker(const Stage& stage, const JobFunction& work, const WorkerOptions& options) {
  return WorkerLoop(stage, work, options).run();
}

}  // namespace meshfarm
