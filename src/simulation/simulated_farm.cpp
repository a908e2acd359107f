// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/simulated_farm.hpp"

#include <algorithm>
#include <utility>

namespace meshfarm {
namespace {

/// Events between checks of the plan job by job: the more jobs, the fewer checks.
constexpr std::uint64_t k_events_per_look = 4096;

std::uint32_t hosts_of(const SimulationOptions& options) {
  std::uint32_t hosts = 0;
  for (const SimulatedWorker& worker : options.workers) hosts = std::max(hosts, worker.host + 1);
  return hosts + (options.other ? 4 : 2);  // and the ventilators' and the sinks'
}

}  // namespace

SimulatedFarm::SimulatedFarm(const JobSource& source, const SimulationOptions& options)
    : options_(options),
      dice_(options.seed),
      hosts_(hosts_of(options)),
      wires_(options, hosts_, dice_, queue_),
      folder_(options, hosts_, dice_, queue_),
      workers_(options.workers.size()) {
  runs_.resize(options.other ? 2 : 1);
  runs_.front().source = &source;
  runs_.back().source = options.other ? &options.other : &source;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const auto taken = static_cast<std::uint32_t>(2 * (runs_.size() - i));
    runs_[i].key = i == 0 ? k_first_run : k_other_run;
    runs_[i].ventilator.host = hosts_ - taken;
    runs_[i].sink.host = hosts_ - taken + 1;
  }
  for (std::uint32_t i = 0; i < workers_.size(); ++i) workers_[i].host = options.workers[i].host;
}

SimulationResult SimulatedFarm::run() {
  start_run(runs_.front());
  if (runs_.size() > 1) {
    queue_.at(options_.other_start, [this] { start_run(runs_.back()); });
  }
  for (std::uint32_t i = 0; i < workers_.size(); ++i) {
    queue_.at(options_.workers[i].start, [this, i] { start_worker(i); });
  }
  plan_faults();
  std::uint64_t next_look = k_events_per_look;
  while (!queue_.empty() && !over() && queue_.now() <= options_.limit && broken().empty()) {
    queue_.step();
    const bool looks = queue_.count() >= next_look;
    if (looks) next_look = queue_.count() + std::max(k_events_per_look, 8 * result_.pushes);
    for (Run& run : runs_) {
      if (!run.ventilator.core) continue;
      run.checks.plan(*run.ventilator.core);
      if (looks) run.checks.whole_plan(run.ventilator.core->plan());
    }
  }
  for (Run& run : runs_) {
    if (is_over(run) && run.failure.empty()) {
      run.checks.that(!run.outputs.empty(), "there is no output");
    }
  }
  for (const Worker& worker : workers_) {
    checks_.that(!stays_behind(worker), "a worker stays with a run that is over");
  }
  tell_result();
  return std::move(result_);
}

void SimulatedFarm::start_run(Run& run) {
  start_ventilator(run);
  queue_.in(up_to(std::chrono::milliseconds(options_.faults.end.count() > 0 ? 2000 : 0)),
            [this, &run] { start_sink(run); });
}

void SimulatedFarm::tell_result() {
  result_.ended = over();
  result_.broken = broken();
  result_.time = queue_.now();
  result_.server_busy_s = folder_.server_busy_s();
  result_.events = queue_.count();
  result_.runs = runs_.front().starts;
  result_.failure = std::move(runs_.front().failure);
  result_.outputs = std::move(runs_.front().outputs);
  if (runs_.size() == 1) return;
  result_.other_failure = std::move(runs_.back().failure);
  result_.other_outputs = std::move(runs_.back().outputs);
}

std::string SimulatedFarm::broken() const {
  for (const Run& run : runs_) {
    if (!run.checks.broken().empty()) return run.checks.broken();
  }
  return checks_.broken();
}

bool SimulatedFarm::is_over(const Run& run) {
  return run.finished && !run.sink.alive && !run.ventilator.alive && !run.restarting;
}

bool SimulatedFarm::stays_behind(const Worker& worker) {
  constexpr std::chrono::seconds k_long{60};  // longer than any delay by faults
  const Run* run = worker.lane.empty() ? nullptr : run_at(worker.dialled);
  return worker.alive && run != nullptr && is_over(*run) &&
         run->finished_at + k_long < queue_.now();
}

bool SimulatedFarm::over() const {
  return std::all_of(runs_.begin(), runs_.end(), [](const Run& run) { return is_over(run); });
}

void SimulatedFarm::note(std::uint64_t what) {
  std::uint64_t& hash = result_.trace_hash;
  hash = (hash ^ what ^ static_cast<std::uint64_t>(queue_.now().count())) * 0x9e3779b97f4a7c15;
  hash ^= hash >> 32;
}

SimulatedFarm::Letter SimulatedFarm::in_envelope(Message message) const {
  if (options_.through_wire) message = decode(encode(message));
  return std::make_shared<const Message>(std::move(message));
}

SimulatedTime SimulatedFarm::up_to(std::chrono::milliseconds longest) {
  return SimulatedTime(dice_.pick(static_cast<std::uint64_t>(SimulatedTime(longest).count())));
}

void SimulatedFarm::kill(Process& process) {
  ++process.life;
  process.alive = false;
  process.asleep_until = SimulatedTime(0);
}

SimulationResult simulate_farm(const JobSource& source, const SimulationOptions& options) {
  return SimulatedFarm(source, options).run();
}

}  // namespace meshfarm
