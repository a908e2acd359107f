// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "farm/simulated_farm.hpp"

#include <algorithm>
#include <utility>

namespace meshfarm {
namespace {

/// So often the plan is looked through job by job: the more there are, the more seldom.
constexpr std::uint64_t k_events_per_look = 4096;

std::uint32_t hosts_of(const SimulationOptions& options) {
  std::uint32_t hosts = 0;
  for (const SimulatedWorker& worker : options.workers) hosts = std::max(hosts, worker.host + 1);
  return hosts + 2;  // and the ventilator's and the sink's
}

}  // namespace

SimulatedFarm::SimulatedFarm(const JobSource& source, const SimulationOptions& options)
    : source_(source),
      options_(options),
      dice_(options.seed),
      hosts_(hosts_of(options)),
      wires_(options, hosts_, dice_, queue_),
      folder_(options, hosts_, dice_, queue_),
      workers_(options.workers.size()) {
  ventilator_.host = hosts_ - 2;
  sink_.host = hosts_ - 1;
  for (std::uint32_t i = 0; i < workers_.size(); ++i) workers_[i].host = options.workers[i].host;
}

SimulationResult SimulatedFarm::run() {
  start_ventilator();
  queue_.in(up_to(std::chrono::milliseconds(options_.faults.end.count() > 0 ? 2000 : 0)),
            [this] { start_sink(); });
  for (std::uint32_t i = 0; i < workers_.size(); ++i) {
    queue_.at(options_.workers[i].start, [this, i] { start_worker(i); });
  }
  plan_faults();
  std::uint64_t next_look = k_events_per_look;
  while (!queue_.empty() && !over() && queue_.now() <= options_.limit && checks_.broken().empty()) {
    queue_.step();
    if (ventilator_.core) {
      checks_.plan(*ventilator_.core);
      if (queue_.count() >= next_look) {
        checks_.whole_plan(ventilator_.core->plan());
        next_look = queue_.count() + std::max(k_events_per_look, 8 * result_.pushes);
      }
    }
  }
  if (over() && !said_failure_) checks_.that(!result_.outputs.empty(), "there is no output");
  result_.ended = over();
  result_.broken = checks_.broken();
  result_.time = queue_.now();
  result_.server_busy_s = folder_.server_busy_s();
  result_.events = queue_.count();
  return std::move(result_);
}

bool SimulatedFarm::over() const {
  return finished_ && !sink_.alive && !ventilator_.alive && !restarting_;
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
