// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include <meshfarm/farm/worker_core.hpp>
#include <meshfarm/transport/worker.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

#include "transport/control_link.hpp"
#include "transport/job_slot.hpp"
#include "transport/sockets.hpp"
#include "transport/task_thread.hpp"
#include "transport/turn_gate.hpp"

namespace meshfarm {
namespace {

/// Limits messages per turn, so that a flood cannot keep the loop from checking the clock.
constexpr int k_worker_messages_per_turn = 1000;
constexpr FarmTime k_memory_every{500};
const ReadPatience k_second_readers_patience = {.missing = k_second_reader_waits,
                                                .failing = k_second_reader_waits};

WorkerLimits limits_of(const WorkerOptions& options) {
  WorkerLimits limits = limits_of(options.capacity, options.buffer);
  limits.grace = options.grace;
  return limits;
}

/// The sockets and job slots around a WorkerCore, which makes all decisions.
class WorkerLoop {
 public:
  WorkerLoop(const Stage& stage, const JobFunction& work, const WorkerOptions& options)
      : stage_(stage),
        options_(options),
        incarnation_(random_id()),
        context_(make_context()),
        link_(context_, stage, options.security),
        core_({Role::worker,
               options.run,
               incarnation_,
               static_cast<std::uint32_t>(::getpid()),
               clipped(host_name()),
               {},
               options.patience,
               options.capacity,
               options.algorithm},
              limits_of(options)),
        gates_(std::max(1U, options.capacity.threads)) {
    for (std::uint32_t i = 0; i < limits_of(options).slots; ++i) {
      slots_.push_back(std::make_unique<JobSlot>(stage, work, gates_, incarnation_));
    }
  }

  WorkerReport run() {
    while (!left_) {
      if (options_.stop != nullptr && options_.stop->load()) perform(core_.stop());
      turn();
    }
    if (!left_->incomplete.empty()) throw IncompleteError(left_->incomplete);
    WorkerReport report = core_.report();
    const std::chrono::duration<double> span = last_end_ - first_begin_.value_or(last_end_);
    report.span_seconds = span.count();
    report.compute_seconds = std::chrono::duration<double>(computed_).count();
    return report;
  }

 private:
  void turn() {
    std::vector<zmq::pollitem_t> items;
    for (const auto& slot : slots_) items.push_back({nullptr, slot->fd(), ZMQ_POLLIN, 0});
    if (reader_) items.push_back({nullptr, reader_->fd(), ZMQ_POLLIN, 0});
    if (link_.socket() != nullptr) items.push_back({link_.socket()->handle(), 0, ZMQ_POLLIN, 0});
    if (lane_) items.push_back({lane_->handle(), 0, ZMQ_POLLIN, 0});
    wait_for(items, core_.pause(farm_clock()));
    const FarmTime now = farm_clock();
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i]->take_finished()) finish(i, now);
    }
    if (reader_ && reader_->take_finished()) {
      perform(core_.tried(to_read_.front(), readable_));
      to_read_.pop_front();
      read_next();
    }
    for (int count = 0; link_.socket() != nullptr && count < k_worker_messages_per_turn; ++count) {
      const auto received = receive(*link_.socket());
      if (!received) break;
      if (received->message) perform(core_.on_control(*received->message, now));
    }
    for (int count = 0; lane_ && count < k_worker_messages_per_turn; ++count) {
      const auto received = receive(*lane_);
      if (!received) break;
      if (received->message) perform(core_.on_lane(*received->message, now));
    }
    if (next_look_at_memory_ <= now) {
      next_look_at_memory_ = now + k_memory_every;
      rss_bytes_ = resident_memory();
    }
    perform(core_.tick(pulse(), now));
  }

  WorkerPulse pulse() const {
    WorkerPulse pulse;
    for (const auto& slot : slots_) pulse.slots.push_back(slot->pulse());
    pulse.rss_bytes = rss_bytes_;
    return pulse;
  }

  void finish(std::uint32_t slot, FarmTime now) {
    JobSlot& ended = *slots_[slot];
    last_end_ = now;
    computed_ += FarmTime(ended.times().compute_ms);
    perform(core_.finished(slot, std::move(ended.outcome()), now, ended.times()));
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
    lane_.emplace(make_lane_client(context_, link_.keys()));
    connect(*lane_, each.address);
  }
  void act(const ConnectSink& each) {
    if (results_) results_->set(zmq::sockopt::linger, 0);
    results_.reset();
    if (each.address.empty()) return;
    results_.emplace(make_results_client(context_, link_.keys()));
    connect(*results_, each.address);
  }
  void act(const SendResult& each) {
    if (results_) send(*results_, each.result);  // lost results are sent again
  }
  void act(const Begin& each) {
    if (!first_begin_) first_begin_ = farm_clock();
    slots_[each.slot]->begin(each);
  }
  void act(const GiveUp& each) { slots_[each.slot]->give_up(); }
  void act(const ReadForSink& each) {
    constexpr std::size_t k_most = 64;
    if (to_read_.size() >= k_most) return;  // the asker has a timeout of its own
    to_read_.push_back(each.what);
    if (!reader_) reader_.emplace();
    if (reader_->idle()) read_next();
  }
  void read_next() {
    if (to_read_.empty()) return;
    reader_->start([this, file = to_read_.front().file] {
      try {
        stage_.verify(file, k_second_readers_patience);
        readable_ = true;
      } catch (const std::exception&) {
        readable_ = false;
      }
    });
  }
  void act(const Leave& each) {
    left_ = each;
    if (each.abort && options_.abort) options_.abort(each.incomplete);
  }

  static void connect(zmq::socket_t& socket, const std::string& address) {
    try {
      socket.connect(address);
    } catch (const zmq::error_t& error) {
      log_debug("cannot connect to '" + address + "': " + error.what());
    }
  }

  const Stage& stage_;
  const WorkerOptions& options_;
  std::uint64_t incarnation_;
  zmq::context_t context_;
  ControlLink link_;
  std::optional<zmq::socket_t> lane_;
  std::optional<zmq::socket_t> results_;
  WorkerCore core_;
  std::optional<Leave> left_;
  std::optional<FarmTime> first_begin_;
  FarmTime last_end_{0};
  FarmTime computed_{0};
  FarmTime next_look_at_memory_{0};
  std::uint64_t rss_bytes_ = 0;
  WorkerGates gates_;
  std::deque<TryRead> to_read_;  // the first is being read
  bool readable_ = false;        // owned by the reader while it works
  // The last members, so that their threads end first.
  std::vector<std::unique_ptr<JobSlot>> slots_;
  std::optional<TaskThread> reader_;  // started once the sink could not read something
};

}  // namespace

WorkerReport run_worker(const Stage& stage, const JobFunction& work, const WorkerOptions& options) {
  return WorkerLoop(stage, work, options).run();
}

}  // namespace meshfarm
