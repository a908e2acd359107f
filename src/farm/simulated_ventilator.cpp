// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <utility>

#include "farm/simulated_farm.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_run = 7;
constexpr std::chrono::milliseconds k_down{8000};  // a killed process comes again within this
constexpr std::chrono::milliseconds k_pause_between_runs{5000};

std::string lane_name(std::uint32_t epoch, WorkerId id) {
  return "l" + std::to_string(epoch) + "." + std::to_string(id.value);
}

}  // namespace

void SimulatedFarm::start_ventilator() {
  ventilator_.alive = true;
  const std::uint64_t life = ++ventilator_.life;
  ventilator_.epoch = epochs_ + 1;
  finished_ = false;
  ++result_.runs;
  run_start_ = queue_.now();
  checks_.epoch_begins();
  members_.clear();
  DispatcherOptions dispatcher;
  dispatcher.run = k_run;
  dispatcher.epoch = ventilator_.epoch;
  dispatcher.heartbeat = options_.heartbeat;
  dispatcher.schedule = options_.schedule;
  dispatcher.when_full = options_.when_full;
  ventilator_.core.emplace(Plan(source_, options_.max_attempts), dispatcher);
  announce(k_run, "v");
  note(ventilator_.epoch);
  tick_ventilator(life);
}

/// The next epoch, of a ventilator, or by an empty address the word that its run is over.
void SimulatedFarm::announce(std::uint64_t run, const std::string& address) {
  const std::uint32_t epoch = ++epochs_;
  const std::string name = address.empty() ? address : address + std::to_string(epoch);
  endpoints_.push_back({epoch, run, name, "host", 1, {}});
  if (options_.faults.late_endpoint <= 0 || !faulty()) return;
  constexpr std::chrono::milliseconds k_longest{20'000};
  for (std::uint32_t host = 0; host < hosts_; ++host) {
    if (!chance(options_.faults.late_endpoint)) continue;
    seen_from_[{host, epoch}] = queue_.now() + up_to(k_longest);
  }
}

std::vector<Endpoint> SimulatedFarm::endpoints_seen(std::uint32_t host) {
  if (seen_from_.empty()) return endpoints_;
  std::vector<Endpoint> seen;
  for (const Endpoint& each : endpoints_) {
    const auto late = seen_from_.find({host, each.epoch});
    if (late == seen_from_.end() || late->second <= queue_.now()) seen.push_back(each);
  }
  return seen;
}

/// Another run of the stage, whose ventilator never answers: it was killed, or is cut off.
void SimulatedFarm::change_other_run() {
  constexpr std::uint64_t k_runs = 3;
  const std::uint64_t run = k_run + 1 + dice_.pick(k_runs);
  announce(run, dice_.chance(0.5) ? "g" : "");
}

void SimulatedFarm::tick_ventilator(std::uint64_t life) {
  if (!ventilator_.alive || ventilator_.life != life) return;
  if (ventilator_.asleep_until > queue_.now()) {
    // Behind the messages that came meanwhile: nobody is silent whose words are still to be read.
    queue_.at(ventilator_.asleep_until + SimulatedTime(1000),
              [this, life] { tick_ventilator(life); });
    return;
  }
  ventilator_does(ventilator_.core->tick(farm_now()));
  look_at_bans();
  queue_.in(options_.heartbeat / (options_.centre.eager ? 10 : 4),
            [this, life] { tick_ventilator(life); });
}

void SimulatedFarm::look_at_bans() {
  if (!ventilator_.core) return;
  for (std::string& host : ventilator_.core->scheduler().bad_hosts()) {
    result_.banned_hosts.insert(std::move(host));
  }
}

void SimulatedFarm::kill_ventilator() {
  if (!ventilator_.alive) return;
  kill(ventilator_);
  ventilator_.core.reset();
  queue_.in(up_to(k_down), [this] {
    if (!ventilator_.alive) start_ventilator();
  });
}

void SimulatedFarm::to_ventilator(const Process& sender, SimulatedChannel& channel,
                                  const std::string& peer, std::uint32_t epoch, Message message) {
  // What a killed process had not yet given to the network is lost with it.
  const bool buffered = chance(0.5);
  channel.to = ventilator_.host;
  wires_.send(channel, SimulatedWires::Order::kept,
              [this, &sender, buffered, life = sender.life, peer, epoch,
               letter = in_envelope(std::move(message))] {
                if (buffered && sender.life != life) return;
                if (ventilator_.epoch != epoch) return;
                in_its_turn(centre_free_, options_.centre.per_message, [this, peer, letter] {
                  when_awake(ventilator_, ventilator_.life,
                             [this, peer, letter] { ventilator_hears(peer, *letter); });
                });
              });
}

void SimulatedFarm::ventilator_hears(const std::string& peer, const Message& message) {
  const auto* credit = std::get_if<Credit>(&message);
  if (credit != nullptr && credit->epoch == ventilator_.epoch) {
    checks_.credit(credit->worker, credit->up_to);
  }
  note(message.index());
  ventilator_does(ventilator_.core->on_message(peer, message, farm_now()));
  if (options_.centre.eager && ventilator_.alive) {
    ventilator_does(ventilator_.core->tick(farm_now()));
  }
}

void SimulatedFarm::ventilator_does(Actions actions) {
  const std::uint64_t life = ventilator_.life;
  for (Action& action : actions) {
    if (!ventilator_.alive || ventilator_.life != life) return;
    std::visit([this](auto& each) { act(each); }, action);
  }
}

/// Peers are named "w3.17" and "s18": whose, and the number of the connection.
SimulatedFarm::Worker* SimulatedFarm::worker_at(const std::string& peer) {
  if (peer.empty() || peer[0] != 'w') return nullptr;
  std::uint32_t index = 0;
  std::from_chars(peer.data() + 1, peer.data() + peer.size(), index);
  Worker& worker = workers_[index];
  return worker.alive && worker.peer == peer ? &worker : nullptr;
}

void SimulatedFarm::act(SendTo& each) {
  if (const auto* done = std::get_if<Done>(&each.message)) checks_.told_done(each.peer, done->key);
  if (Worker* worker = worker_at(each.peer)) {
    if (const auto* welcome = std::get_if<Welcome>(&each.message)) {
      checks_.welcomed(each.peer, welcome->worker);
      members_[welcome->worker] = index_of(*worker);
    }
    to_worker(*worker, each.peer, std::move(each.message));
  } else if (sink_.alive && sink_.peer == each.peer) {
    to_sink(each.peer, std::move(each.message));
  }
}

void SimulatedFarm::to_worker(Worker& worker, const std::string& peer, Message message) {
  worker.from_ventilator.from = ventilator_.host;
  wires_.send(worker.from_ventilator, SimulatedWires::Order::kept,
              [this, &worker, buffered = chance(0.5), life = ventilator_.life, peer,
               letter = in_envelope(std::move(message))] {
                if (worker.peer != peer || (buffered && ventilator_.life != life)) return;
                when_awake(worker, worker.life, [this, &worker, peer, letter] {
                  if (worker.peer != peer) return;
                  worker_does(index_of(worker), worker.core->on_control(*letter, farm_now()));
                });
              });
}

void SimulatedFarm::to_sink(const std::string& peer, Message message) {
  sink_.from_ventilator.from = ventilator_.host;
  wires_.send(sink_.from_ventilator, SimulatedWires::Order::kept,
              [this, buffered = chance(0.5), life = ventilator_.life, peer,
               letter = in_envelope(std::move(message))] {
                if (buffered && ventilator_.life != life) return;
                when_awake(sink_, sink_.life, [this, peer, letter] {
                  if (sink_.peer != peer) return;
                  sink_does(sink_.core->on_control(*letter, farm_now()));
                });
              });
}

void SimulatedFarm::act(OpenLane& each) {
  if (chance(options_.faults.lane_fails)) {
    return ventilator_does(ventilator_.core->lane_failed(each.worker, "no port is free"));
  }
  ventilator_does(
      ventilator_.core->lane_opened(each.worker, lane_name(ventilator_.epoch, each.worker)));
}

void SimulatedFarm::act(CloseLane& each) {
  checks_.lane_closed(each.worker);
}

void SimulatedFarm::act(PushJob& each) {
  checks_.pushed(each.worker, each.key, each.assignment);
  note(each.key.value);
  if (result_.pushes++ == 0) result_.first_push = queue_.now();
  Worker& worker = workers_[members_.at(each.worker)];
  worker.lane_channel.from = ventilator_.host;
  wires_.send(worker.lane_channel, SimulatedWires::Order::kept,
              [this, &worker, life = worker.life, name = lane_name(ventilator_.epoch, each.worker),
               letter = in_envelope(std::move(each.assignment))] {
                when_awake(worker, life, [this, &worker, name, letter] {
                  if (worker.lane != name) return;
                  worker_does(index_of(worker), worker.core->on_lane(*letter, farm_now()));
                });
              });
}

void SimulatedFarm::act(ProbeStage& each) {
  const SimulatedTime written = folder_.transfer(ventilator_.host, each.bytes);
  queue_.at(written, [this, life = ventilator_.life] {
    when_awake(ventilator_, life, [this] {
      const char* problem = folder_.full() ? "no space left on device" : "";
      ventilator_does(ventilator_.core->probed(problem, farm_now()));
    });
  });
}

void SimulatedFarm::act(Finish& each) {
  result_.failure = each.failure;
  finished_ = true;
  said_failure_ = !each.failure.empty();
  kill(ventilator_);
  ventilator_.core.reset();
  announce(k_run, {});
  note(each.failure.size());
  // Whoever started the run reads why it failed, and starts it again.
  restarting_ = said_failure_ && run_start_ < failing_ends();
  if (restarting_) queue_.in(k_pause_between_runs, [this] { run_again(); });
}

/// Until when a run may begin that fails for faults: files that cannot be read are so for minutes.
SimulatedTime SimulatedFarm::failing_ends() const {
  const SimulatedFaults& faults = options_.faults;
  const bool sick = faults.sick_mounts > 0 || faults.sick_sink > 0 || faults.lost_parts > 0;
  const bool hopeless = !faults.poison.empty() || !faults.bad.empty();
  return sick && !hopeless ? faults.end + std::chrono::minutes(5) : faults.end;
}

void SimulatedFarm::run_again() {
  restarting_ = false;
  start_ventilator();
  start_sink();
  for (std::uint32_t i = 0; i < workers_.size(); ++i) start_worker(i);
}

}  // namespace meshfarm
