// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "simulation/simulated_farm.hpp"

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_worker_down{6000};
/// Longer than all faults, so that nobody's patience ends.
constexpr FarmTime k_worker_patience = std::chrono::hours(2);

}  // namespace

void SimulatedFarm::start_worker(std::uint32_t index) {
  Worker& worker = workers_[index];
  const SimulatedWorker& is = options_.workers[index];
  const std::optional<std::uint64_t> serves = worker.alive ? std::nullopt : run_for(is.serves);
  if (!serves) return;
  start_member(worker);
  worker.leaves = false;
  worker.incarnation = dice_.next() | 1;
  worker.to_sink = worker.lane_channel = {};
  worker.to_sink.from = worker.lane_channel.to = worker.host;
  MemberOptions member;
  worker.serves = member.run = *serves;
  member.incarnation = worker.incarnation;
  member.pid = index + 1;
  member.host = "host" + std::to_string(worker.host);
  member.patience = k_worker_patience;
  const double told = is.told_speed > 0 ? is.told_speed : is.speed;
  member.capacity.speed = static_cast<std::uint64_t>(told * options_.triangles_per_s);
  member.capacity.memory = is.memory;
  member.capacity.memory_pool = is.memory_pool;
  member.capacity.threads = is.threads;
  const WorkerLimits limits = limits_of(member.capacity, options_.buffer);
  worker.slots.assign(limits.slots, std::nullopt);
  worker.to_read.clear();
  worker.to_compute.clear();
  worker.reading = worker.computing = 0;
  worker.pulse = {};
  worker.pulse.slots.resize(worker.slots.size());
  worker.core = std::make_unique<WorkerCore>(member, limits);
  tick_worker(index, worker.life);
}

/// The run that a worker starting now is told to serve, 0 for any; nothing if there is none for it.
std::optional<std::uint64_t> SimulatedFarm::run_for(SimulatedWorker::Serves serves) {
  std::vector<std::uint64_t> unfinished;
  for (const Run& run : runs_) {
    if (!run.finished) unfinished.push_back(run.key);
  }
  const auto is_open = [&](const Run& run) { return !run.finished; };
  switch (serves) {
    case SimulatedWorker::Serves::any:
      break;
    case SimulatedWorker::Serves::first:
      return is_open(runs_.front()) ? std::optional(runs_.front().key) : std::nullopt;
    case SimulatedWorker::Serves::other:
      return is_open(runs_.back()) ? std::optional(runs_.back().key) : std::nullopt;
    case SimulatedWorker::Serves::pool:
      if (unfinished.empty()) return std::nullopt;
      return unfinished[dice_.pick(unfinished.size())];
  }
  return unfinished.empty() ? std::nullopt : std::optional<std::uint64_t>(0);
}

void SimulatedFarm::tick_worker(std::uint32_t index, std::uint64_t life) {
  Worker& worker = workers_[index];
  if (!worker.alive || worker.life != life) return;
  when_awake(worker, life, [this, &worker] {
    feel_pulse(worker);
    worker_does(index_of(worker), worker.core->tick(worker.pulse, farm_now()));
  });
  queue_.in(options_.heartbeat / 4 + up_to(options_.heartbeat / 2),
            [this, index, life] { tick_worker(index, life); });
}

void SimulatedFarm::kill_worker(std::uint32_t index) {
  Worker& worker = workers_[index];
  if (!worker.alive) return;
  end_member(worker);
  worker.core.reset();
  worker.lane.clear();
  worker.sink.clear();
  queue_.in(up_to(k_worker_down), [this, index] { start_worker(index); });
}

/// Like SIGTERM: it gives back its jobs, ends those in work, and another worker comes.
void SimulatedFarm::ask_to_leave(std::uint32_t index) {
  Worker& worker = workers_[index];
  if (!worker.alive || worker.asleep_until > queue_.now()) return;
  worker.leaves = true;
  worker_does(index, worker.core->stop());
}

void SimulatedFarm::worker_does(std::uint32_t index, WorkerActions actions) {
  Worker& worker = workers_[index];
  const std::uint64_t life = worker.life;
  for (WorkerAction& action : actions) {
    if (!worker.alive || worker.life != life) return;
    std::visit([&](auto& each) { act(index, each); }, action);
  }
  if (!worker.core) return;
  const auto in_work = static_cast<std::size_t>(std::count_if(
      worker.slots.begin(), worker.slots.end(), [](const auto& slot) { return slot.has_value(); }));
  checks_.that(worker.core->waiting() + in_work <= options_.buffer + worker.slots.size(),
               "a worker holds too much");
}

void SimulatedFarm::act(std::uint32_t index, Look&) {
  const std::uint32_t host = workers_[index].host;
  worker_does(index, workers_[index].core->found(endpoints_seen(host), farm_now()));
}

void SimulatedFarm::act(std::uint32_t index, Dial& each) {
  dial(workers_[index], "w" + std::to_string(index) + ".", each);
}

void SimulatedFarm::act(std::uint32_t index, HangUp&) {
  workers_[index].peer.clear();
  workers_[index].lane.clear();
}

void SimulatedFarm::act(std::uint32_t index, Say& each) {
  say(workers_[index], std::move(each.message));
}

void SimulatedFarm::act(std::uint32_t index, ConnectLane& each) {
  workers_[index].lane = each.address;
}

void SimulatedFarm::act(std::uint32_t index, ConnectSink& each) {
  workers_[index].sink = each.address;
}

void SimulatedFarm::act(std::uint32_t index, SendResult& each) {
  Worker& worker = workers_[index];
  const bool buffered = chance(0.5);
  const Run* known = run_of_sink(worker.sink);
  worker.to_sink.to = (known != nullptr ? *known : runs_.front()).sink.host;
  wires_.send(worker.to_sink, SimulatedWires::Order::may_change,
              [this, &worker, buffered, life = worker.life, sink = worker.sink,
               letter = in_envelope(std::move(each.result))] {
                if (buffered && worker.life != life) return;
                Run* run = run_of_sink(sink);
                if (run == nullptr || !run->sink.alive) return;
                when_awake(run->sink, run->sink.life, [this, run, letter] {
                  sink_does(*run, run->sink.core->on_result(*letter));
                });
              });
}

SimulatedFarm::Run* SimulatedFarm::run_of_sink(const std::string& address) {
  const auto at = std::find_if(runs_.begin(), runs_.end(),
                               [&](const Run& run) { return run.sink.here == address; });
  return at == runs_.end() ? nullptr : &*at;
}

void SimulatedFarm::act(std::uint32_t index, ReadForSink& each) {
  Worker& worker = workers_[index];
  const SimulatedTime gives_up = queue_.now() + k_second_reader_waits;
  const SimulatedTime there =
      std::max(folder_.transfer(worker.host, each.what.file.size), folder_.readable(worker.host));
  const bool readable = there <= gives_up && folder_.has_whole(each.what.file.name);
  queue_.at(std::min(there, gives_up),
            [this, index, what = each.what, readable, life = worker.life] {
              when_awake(workers_[index], life, [this, index, what, readable] {
                worker_does(index, workers_[index].core->tried(what, readable));
              });
            });
}

void SimulatedFarm::act(std::uint32_t index, Leave& each) {
  Worker& worker = workers_[index];
  if (each.abort) return kill_worker(index);
  checks_.that(each.incomplete.empty() || worker.leaves, "a worker gave up looking");
  end_member(worker);
  worker.core.reset();
  worker.lane.clear();
  // Maybe by a late message of a run that was over, after another one has begun.
  const bool begun_again =
      std::any_of(runs_.begin(), runs_.end(), [](const Run& run) { return run.starts > 1; });
  // Or a sink was killed while it made the output, and the next one found a damaged result.
  const bool sink_comes_again = options_.faults.decay > 0;
  const bool comes_again =
      faulty() || worker.leaves || begun_again || sink_comes_again || runs_.size() > 1;
  if (comes_again) queue_.in(k_worker_down, [this, index] { start_worker(index); });
}

}  // namespace meshfarm
