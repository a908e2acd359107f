// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include <meshfarm/farm/dispatcher.hpp>
#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/farm/membership.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/transport/ventilator.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "transport/gatekeeper.hpp"
#include "transport/run_keys.hpp"
#include "transport/sockets.hpp"
#include "transport/task_thread.hpp"

namespace meshfarm {
namespace {

constexpr int k_ventilator_messages_per_turn = 1000;
constexpr FarmTime k_progress_every{500};
constexpr FarmTime k_state_every{1000};
constexpr FarmTime k_look_every{1000};
constexpr FarmTime k_state_every_per_worker{5};

/// A job that no message can carry is the caller's mistake, and is found before anything is sent.
/// The sink creates its own jobs itself.
JobSource checked_source(const JobSource& source) {
  return [source] {
    JobGraph graph = source();
    graph.inspect([](const Job& job) {
      if (!job.by_sink) encode(Assignment{0, 0, 0, 0, job});
    });
    return graph;
  };
}

/// The sockets around a Dispatcher, which makes all decisions.
class VentilatorLoop {
 public:
  VentilatorLoop(const Stage& stage, const JobSource& source, const VentilatorOptions& options)
      : stage_(stage),
        options_(options),
        unique_(to_hex(random_id())),
        keys_(keys_to_serve(stage, options.run, options.security)),
        context_(make_context()),
        gate_(context_, keys_),
        control_(make_control_server(context_, keys_)),
        endpoint_(announce()),
        dispatcher_(Plan(checked_source(source), options.max_attempts),
                    {options.run, endpoint_.epoch, options.heartbeat, options.hang,
                     options.schedule, options.patience, options.when_full,
                     static_cast<bool>(options.event), options.algorithm}) {}

  FarmProgress run() {
    if (options_.event) options_.event(RunBegan{endpoint_.epoch, endpoint_.host}, FarmTime(0));
    while (!end_) {
      if (options_.stop != nullptr && options_.stop->load()) {
        perform(dispatcher_.leave());
        throw IncompleteError("stopped; what was accepted is kept in the stage " +
                              stage_.root().string() + ", run the same command again to go on");
      }
      turn();
      look_for_sink(farm_clock());
    }
    if (options_.ended) options_.ended(dispatcher_.progress().sink_present);
    if (options_.progress) options_.progress(progress());
    next_state_ = FarmTime(0);
    tell_state(farm_clock());
    tell_of_strangers(gate_.refused().strangers(), garbage_);
    say_over();
    if (end_->resumable) throw IncompleteError(end_->failure);
    if (!end_->failure.empty()) throw DataError(end_->failure);
    return progress();
  }

 private:
  struct Lane {
    zmq::socket_t socket;
    std::deque<Message> waiting;  // until the worker has connected
  };

  /// Workers that were about to join, or missed the message, see here that the run is over.
  void say_over() {
    try {
      Endpoint last_word{0, options_.run, {}, endpoint_.host, endpoint_.pid, {}};
      last_word.done = end_->failure.empty();
      last_word = publish_endpoint(stage_, last_word, unique_);
      // Earlier endpoints are obsolete; new workers need not read them.
      EndpointList endpoints;
      for (const Endpoint& each : endpoints.look(stage_)) {
        if (each.run == options_.run && each.epoch < last_word.epoch) {
          stage_.remove(EndpointName{each.epoch});
        }
      }
    } catch (const IoError& error) {
      log_warning("late workers cannot be told that the run is over: " + std::string(error.what()));
    }
  }

  Endpoint announce() {
    Endpoint endpoint;
    endpoint.run = options_.run;
    if (keys_) endpoint.server_key = keys_->server_public;
    gate_.watch(control_);
    endpoint.address =
        bind_within(control_, options_.bind, {options_.first_port, options_.last_port});
    endpoint.host = host_name();
    endpoint.pid = static_cast<std::uint32_t>(::getpid());
    endpoint = publish_endpoint(stage_, endpoint, unique_);
    log_info("epoch " + std::to_string(endpoint.epoch) + ", listens on " + endpoint.address);
    return endpoint;
  }

  void turn() {
    std::vector<zmq::pollitem_t> items = {{control_.handle(), 0, ZMQ_POLLIN, 0}};
    if (prober_) items.push_back({nullptr, prober_->fd(), ZMQ_POLLIN, 0});
    for (const WorkerId id : unsent_) {
      items.push_back({lanes_.at(id).socket.handle(), 0, ZMQ_POLLOUT, 0});
    }
    wait_for(items, poll_interval(options_.heartbeat));
    for (const WorkerId id : std::exchange(unsent_, {})) flush(id);
    const FarmTime now = farm_clock();
    int count = 0;
    for (; count < k_ventilator_messages_per_turn && !end_; ++count) {
      const auto received = receive(control_);
      if (!received) break;
      if (received->message) {
        perform(dispatcher_.on_message(received->peer, *received->message, now));
      } else {
        if (received->other_version) refuse_other(*received);
        ++garbage_;
      }
    }
    if (prober_ && prober_->take_finished()) perform(dispatcher_.probed(probe_problem_, now));
    const bool all_read = count < k_ventilator_messages_per_turn;
    perform(dispatcher_.tick(now, all_read ? Dispatcher::Inbox::empty : Dispatcher::Inbox::unread));
    report(now);
    tell_state(now);
  }

  /// A peer of another protocol version is refused in its own version, and logged here once.
  void refuse_other(const Received& received) {
    const std::string versions = "protocol version " + std::to_string(*received.other_version) +
                                 ", this ventilator " + std::to_string(k_protocol_version);
    send_frame(control_, received.peer,
               encode_refusal(
                   *received.other_version,
                   "you speak " + versions + ": start the same build of meshfarm on all hosts"));
    if (!std::exchange(told_of_others_, true)) {
      log_warning("refused: a peer speaks " + versions +
                  "; start the same build of meshfarm on all hosts");
    }
  }

  void report(FarmTime now) {
    if (!options_.progress || now < next_report_) return;
    next_report_ = now + k_progress_every;
    options_.progress(progress());
  }

  void tell_state(FarmTime now) {
    if (!options_.state || now < next_state_) return;
    const std::vector<WorkerStatus> workers = dispatcher_.workers();
    next_state_ =
        now + std::max(k_state_every, k_state_every_per_worker * static_cast<int>(workers.size()));
    options_.state(progress(), workers, now - start_);
  }

  void look_for_sink(FarmTime now) {
    if (!options_.was_completed || now < next_look_) return;
    next_look_ = now + k_look_every;
    if (dispatcher_.progress().sink_present) {
      last_sink_ = now;
    } else if (now - last_sink_ >= options_.patience) {
      last_sink_ = now;
      if (options_.was_completed()) perform(dispatcher_.end_complete());
    }
  }

  FarmProgress progress() const {
    FarmProgress progress = dispatcher_.progress();
    progress.refused = gate_.refused().strangers();
    return progress;
  }

  void perform(const Actions& actions) {
    for (const Action& action : actions) {
      std::visit([this](const auto& each) { act(each); }, action);
    }
  }

  void act(const SendTo& each) {
    if (!send(control_, each.peer, each.message)) log_debug("a message to a lost peer was dropped");
  }

  void act(const OpenLane& each) {
    try {
      zmq::socket_t socket = make_lane_server(context_, keys_);
      gate_.watch(socket);
      const std::string address =
          bind_within(socket, options_.bind, {options_.first_port, options_.last_port});
      lanes_.emplace(each.worker, Lane{std::move(socket), {}});
      perform(dispatcher_.lane_opened(each.worker, address));
    } catch (const IoError& error) {
      refuse(each.worker, error.what());
    } catch (const zmq::error_t& error) {
      refuse(each.worker, error.what());
    }
  }

  void refuse(WorkerId worker, const std::string& reason) {
    log_warning("a worker is turned away, no lane can be opened: " + reason);
    perform(dispatcher_.lane_failed(worker, reason));
  }

  void act(const CloseLane& each) {
    std::erase(unsent_, each.worker);
    lanes_.erase(each.worker);
  }

  void act(const PushJob& each) {
    lanes_.at(each.worker).waiting.emplace_back(each.assignment);
    flush(each.worker);
  }

  void act(const ProbeStage& each) {
    if (!prober_) prober_.emplace();
    prober_->start([this, bytes = each.bytes] {
      try {
        probe_room(stage_.root() / "results", bytes);
        probe_problem_.clear();
      } catch (const std::exception& error) {
        probe_problem_ = error.what();
      }
    });
  }

  void act(const Finish& each) { end_ = each; }
  void act(const Tell& each) {
    if (options_.event) options_.event(each.event, farm_clock() - start_);
  }

  void flush(WorkerId id) {
    const auto found = lanes_.find(id);
    if (found == lanes_.end()) return;
    Lane& lane = found->second;
    while (!lane.waiting.empty() && send(lane.socket, lane.waiting.front())) {
      lane.waiting.pop_front();
    }
    const bool listed = std::find(unsent_.begin(), unsent_.end(), id) != unsent_.end();
    if (!lane.waiting.empty() && !listed) unsent_.push_back(id);
  }

  const Stage& stage_;
  const VentilatorOptions& options_;
  std::string unique_;
  Keys keys_;
  zmq::context_t context_;
  Gatekeeper gate_;
  zmq::socket_t control_;
  Endpoint endpoint_;
  Dispatcher dispatcher_;
  std::map<WorkerId, Lane> lanes_;
  std::vector<WorkerId> unsent_;  // lanes with waiting messages
  FarmTime start_ = farm_clock();
  FarmTime next_report_{0};
  FarmTime next_state_{0};
  FarmTime next_look_{0};
  FarmTime last_sink_ = start_;
  std::uint64_t garbage_ = 0;
  bool told_of_others_ = false;
  std::optional<Finish> end_;
  std::string probe_problem_;         // owned by the prober while it works
  std::optional<TaskThread> prober_;  // once the stage was full; the last member, as it ends first
};

}  // namespace

FarmProgress run_ventilator(const Stage& stage, const JobSource& source,
                            const VentilatorOptions& options) {
  check_exposure(options.security, options.bind);
  return VentilatorLoop(stage, source, options).run();
}

}  // namespace meshfarm
