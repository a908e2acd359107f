// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "simulation/simulated_farm.hpp"

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_longest_pause{12'000};
constexpr std::chrono::milliseconds k_longest_stall{20'000};

}  // namespace

void SimulatedFarm::repeat(double rate_per_minute, const std::function<void()>& fault) {
  if (rate_per_minute <= 0) return;
  const double minutes = -std::log(1 - dice_.fraction()) / rate_per_minute;
  const auto wait = SimulatedTime(static_cast<std::int64_t>(std::min(minutes, 1e6) * 60e6));
  if (queue_.now() + wait >= options_.faults.end) return;
  queue_.in(wait, [this, rate_per_minute, fault] {
    fault();
    repeat(rate_per_minute, fault);
  });
}

/// Mostly longer than a reader's patience.
SimulatedTime SimulatedFarm::some_minutes() {
  return std::chrono::seconds(60) + up_to(std::chrono::minutes(3));
}

SimulatedFarm::Run& SimulatedFarm::any_run() {
  return runs_.size() == 1 ? runs_.front() : runs_[dice_.pick(runs_.size())];
}

void SimulatedFarm::plan_faults() {
  const SimulatedFaults& faults = options_.faults;
  const auto until = [this](std::chrono::milliseconds longest) {
    return std::min(options_.faults.end, queue_.now() + up_to(longest));
  };
  const auto pause = [=](Process& process) { process.asleep_until = until(k_longest_pause); };
  const auto any_worker = [this] {
    return static_cast<std::uint32_t>(dice_.pick(workers_.size()));
  };
  const auto of_workers = [&](double rate) { return rate * static_cast<double>(workers_.size()); };
  repeat(of_workers(faults.worker_crashes), [=, this] { kill_worker(any_worker()); });
  repeat(of_workers(faults.worker_pauses), [=, this] { pause(workers_[any_worker()]); });
  repeat(of_workers(faults.host_cuts), [=, this] {
    const auto host = static_cast<std::uint32_t>(dice_.pick(hosts_));
    wires_.cut(host, until(k_longest_pause));
  });
  repeat(of_workers(faults.worker_leaves), [=, this] { ask_to_leave(any_worker()); });
  repeat(faults.other_runs, [this] { change_other_run(); });
  repeat(faults.sink_crashes, [this] { kill_sink(any_run()); });
  repeat(faults.sink_pauses, [=, this] { pause(any_run().sink); });
  repeat(faults.ventilator_crashes, [this] { kill_ventilator(any_run()); });
  repeat(faults.ventilator_pauses, [=, this] { pause(any_run().ventilator); });
  const auto sicken = [this](std::uint32_t host) {
    folder_.sicken(host, queue_.now() + some_minutes());
  };
  repeat(of_workers(faults.sick_mounts), [=, this] { sicken(workers_[any_worker()].host); });
  repeat(faults.sick_sink, [=, this] { sicken(any_run().sink.host); });
  repeat(faults.storage_stalls, [=, this] { folder_.stall(until(k_longest_stall)); });
  repeat(faults.disk_fills, [=, this] { folder_.fill(until(k_longest_stall)); });
}

}  // namespace meshfarm
