// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <utility>

#include "simulation/simulated_farm.hpp"

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_ventilator_down{
    8000};  // a killed process comes again within this
constexpr std::chrono::seconds k_without_sink{60};
constexpr std::chrono::milliseconds k_pause_between_runs{5000};

std::string lane_name(std::uint32_t epoch, WorkerId id) {
  return "l" + std::to_string(epoch) + "." + std::to_string(id.value);
}

}  // namespace

void SimulatedFarm::start_ventilator(Run& run) {
  run.ventilator.alive = true;
  const std::uint64_t life = ++run.ventilator.life;
  run.ventilator.epoch = epochs_ + 1;
  run.finished = false;
  ++run.starts;
  run.started = queue_.now();
  run.checks.epoch_begins();
  run.members.clear();
  DispatcherOptions dispatcher;
  dispatcher.run = run.key;
  dispatcher.epoch = run.ventilator.epoch;
  dispatcher.heartbeat = options_.heartbeat;
  dispatcher.schedule = options_.schedule;
  dispatcher.when_full = options_.when_full;
  run.ventilator.core.emplace(Plan(*run.source, options_.max_attempts), dispatcher);
  announce(run.key, "v");
  note(run.ventilator.epoch);
  tick_ventilator(run, life);
}

/// Publishes the next epoch: of a ventilator, or, with an empty address, the notice that its run is
/// over.
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

/// Another run of the stage whose ventilator never answers: it was killed, or is cut off.
void SimulatedFarm::change_other_run() {
  constexpr std::uint64_t k_runs = 3;
  const std::uint64_t other = k_first_run + 1 + dice_.pick(k_runs);
  announce(other, dice_.chance(0.5) ? "g" : "");
}

void SimulatedFarm::tick_ventilator(Run& run, std::uint64_t life) {
  if (!run.ventilator.alive || run.ventilator.life != life) return;
  if (run.ventilator.asleep_until > queue_.now()) {
    // After the messages that arrived meanwhile: a peer with unread messages is not silent.
    queue_.at(run.ventilator.asleep_until + SimulatedTime(1000),
              [this, &run, life] { tick_ventilator(run, life); });
    return;
  }
  ventilator_does(run, run.ventilator.core->tick(farm_now()));
  look_at_bans(run);
  look_for_output(run);
  queue_.in(options_.heartbeat / (options_.centre.eager ? 10 : 4),
            [this, &run, life] { tick_ventilator(run, life); });
}

/// Like the real one, which learns from the stage why no sink comes.
void SimulatedFarm::look_for_output(Run& run) {
  const bool waits = run.made_output && !run.sink.alive && run.ventilator.core;
  if (!waits || queue_.now() - run.started < k_without_sink) return;
  ventilator_does(run, run.ventilator.core->end_complete());
}

void SimulatedFarm::look_at_bans(const Run& run) {
  if (!run.ventilator.core) return;
  for (std::string& host : run.ventilator.core->scheduler().bad_hosts()) {
    result_.banned_hosts.insert(std::move(host));
  }
}

void SimulatedFarm::kill_ventilator(Run& run) {
  if (!run.ventilator.alive) return;
  kill(run.ventilator);
  run.ventilator.core.reset();
  queue_.in(up_to(k_ventilator_down), [this, &run] {
    if (!run.ventilator.alive) start_ventilator(run);
  });
}

SimulatedFarm::Run* SimulatedFarm::run_at(std::uint32_t epoch) {
  const auto at = std::find_if(runs_.begin(), runs_.end(),
                               [&](const Run& run) { return run.ventilator.epoch == epoch; });
  return at == runs_.end() ? nullptr : &*at;
}

void SimulatedFarm::ventilator_gets(Run& run, const std::string& peer, const Letter& letter) {
  in_its_turn(run.centre_free, options_.centre.per_message, [this, &run, peer, letter] {
    when_awake(run.ventilator, run.ventilator.life,
               [this, &run, peer, letter] { ventilator_hears(run, peer, *letter); });
  });
}

void SimulatedFarm::ventilator_hears(Run& run, const std::string& peer, const Message& message) {
  const auto* credit = std::get_if<Credit>(&message);
  if (credit != nullptr && credit->epoch == run.ventilator.epoch) {
    run.checks.credit(credit->worker, credit->up_to);
  }
  note(message.index());
  ventilator_does(run, run.ventilator.core->on_message(peer, message, farm_now()));
  if (options_.centre.eager && run.ventilator.alive) {
    ventilator_does(run, run.ventilator.core->tick(farm_now()));
  }
}

void SimulatedFarm::ventilator_does(Run& run, Actions actions) {
  const std::uint64_t life = run.ventilator.life;
  for (Action& action : actions) {
    if (!run.ventilator.alive || run.ventilator.life != life) return;
    std::visit([&](auto& each) { act(run, each); }, action);
  }
}

/// Peers are named "w3.17" and "s18": the owner, and the number of the connection.
SimulatedFarm::Worker* SimulatedFarm::worker_at(const std::string& peer) {
  if (peer.empty() || peer[0] != 'w') return nullptr;
  std::uint32_t index = 0;
  std::from_chars(peer.data() + 1, peer.data() + peer.size(), index);
  Worker& worker = workers_[index];
  return worker.alive && worker.peer == peer ? &worker : nullptr;
}

void SimulatedFarm::act(Run& run, SendTo& each) {
  if (const auto* done = std::get_if<Done>(&each.message))
    run.checks.told_done(each.peer, done->key);
  if (Worker* worker = worker_at(each.peer)) {
    if (const auto* welcome = std::get_if<Welcome>(&each.message)) {
      const std::uint64_t serves = worker->serves;
      run.checks.that(serves == 0 || serves == run.key, "a worker is taken by another run");
      run.checks.welcomed(each.peer, welcome->worker);
      run.members[welcome->worker] = index_of(*worker);
    }
    to_member(run, *worker, std::move(each.message), [this, worker](const Message& message) {
      worker_does(index_of(*worker), worker->core->on_control(message, farm_now()));
    });
  } else if (run.sink.alive && run.sink.peer == each.peer) {
    to_member(run, run.sink, std::move(each.message), [this, &run](const Message& message) {
      sink_does(run, run.sink.core->on_control(message, farm_now()));
    });
  }
}

void SimulatedFarm::act(Run& run, OpenLane& each) {
  if (chance(options_.faults.lane_fails)) {
    return ventilator_does(run, run.ventilator.core->lane_failed(each.worker, "no port is free"));
  }
  ventilator_does(run, run.ventilator.core->lane_opened(
                           each.worker, lane_name(run.ventilator.epoch, each.worker)));
}

void SimulatedFarm::act(Run& run, CloseLane& each) {
  run.checks.lane_closed(each.worker);
}

void SimulatedFarm::act(Run& run, PushJob& each) {
  run.checks.pushed(each.worker, each.key, each.assignment);
  note(each.key.value);
  if (result_.pushes++ == 0) result_.first_push = queue_.now();
  Worker& worker = workers_[run.members.at(each.worker)];
  worker.lane_channel.from = run.ventilator.host;
  wires_.send(
      worker.lane_channel, SimulatedWires::Order::kept,
      [this, &worker, life = worker.life, name = lane_name(run.ventilator.epoch, each.worker),
       letter = in_envelope(std::move(each.assignment))] {
        when_awake(worker, life, [this, &worker, name, letter] {
          if (worker.lane != name) return;
          worker_does(index_of(worker), worker.core->on_lane(*letter, farm_now()));
        });
      });
}

void SimulatedFarm::act(Run& run, ProbeStage& each) {
  const SimulatedTime written = folder_.transfer(run.ventilator.host, each.bytes);
  queue_.at(written, [this, &run, life = run.ventilator.life] {
    when_awake(run.ventilator, life, [this, &run] {
      const char* problem = folder_.full() ? "no space left on device" : "";
      ventilator_does(run, run.ventilator.core->probed(problem, farm_now()));
    });
  });
}

void SimulatedFarm::act(Run& run, Finish& each) {
  run.failure = each.failure;
  run.finished = true;
  run.finished_at = queue_.now();
  kill(run.ventilator);
  run.ventilator.core.reset();
  announce(run.key, {});
  note(each.failure.size());
  // The user who started the run reads why it failed, and starts it again.
  // A sink may tell a later ventilator of what failed while there were faults.
  const SimulatedTime begun = std::min(run.started, run.sink_started);
  run.restarting = !run.failure.empty() && begun < failing_ends();
  if (run.restarting) queue_.in(k_pause_between_runs, [this, &run] { run_again(run); });
}

/// Until when a run that starts may fail because of faults: unreadable files stay so for minutes.
SimulatedTime SimulatedFarm::failing_ends() const {
  const SimulatedFaults& faults = options_.faults;
  const bool sick = faults.sick_mounts > 0 || faults.sick_sink > 0 || faults.lost_parts > 0;
  const bool hopeless = !faults.poison.empty() || !faults.bad.empty();
  return sick && !hopeless ? faults.end + std::chrono::minutes(5) : faults.end;
}

void SimulatedFarm::run_again(Run& run) {
  run.restarting = false;
  start_ventilator(run);
  start_sink(run);
  for (std::uint32_t i = 0; i < workers_.size(); ++i) start_worker(i);
}

}  // namespace meshfarm
