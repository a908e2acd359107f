// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <meshfarm/pipeline/planning.hpp>
#include <meshfarm/simulation/simulation.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// The fewest seconds that a job is held to take: the trace counts in milliseconds.
constexpr double k_least_compute_s = 100e-6;

SimulatedTime simulated(double seconds) {
  return SimulatedTime(static_cast<std::int64_t>(seconds * 1e6));
}

double seconds(SimulatedTime time) {
  return std::chrono::duration<double>(time).count();
}

/// The processor's time, as the trace's host may have been busy with other things.
double compute_s(const TraceDone& job) {
  if (job.cpu_us > 0) return static_cast<double>(job.cpu_us) * 1e-6;
  return std::max(k_least_compute_s, job.compute_ms / 1000.0);
}

struct Speed {
  double triangles = 0;
  double seconds = 0;
  double value() const { return seconds > 0 ? triangles / seconds : 0; }
};

/// Knuth's 64-bit congruential generator: the same draw on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return state_ >> 33;
  }
  double fraction() { return static_cast<double>(next()) * 0x1p-31; }

 private:
  std::uint64_t state_;
};

/// Rounds of jobs that are named by their place.
JobSource source_of(std::span<const PlannedJob> jobs) {
  std::map<std::uint32_t, std::vector<Job>> rounds;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    Job job;
    job.kind = "planned";
    job.parameters = std::to_string(i);
    job.cost = jobs[i].triangles;
    rounds[jobs[i].round].push_back(std::move(job));
  }
  return [rounds = std::move(rounds)](std::span<const AcceptedJob> accepted) {
    std::size_t done = accepted.size();
    for (const auto& [number, round] : rounds) {
      if (done == 0) return round;
      done -= std::min(done, round.size());
    }
    return std::vector<Job>{};
  };
}

std::vector<SimulatedWorker> workers_of(const PlannedFarm& farm) {
  std::vector<SimulatedWorker> workers;
  Draw draw(7);
  for (const WorkerGroup& group : farm.groups) {
    for (std::uint64_t i = 0; i < group.count; ++i) {
      SimulatedWorker worker;
      worker.host = static_cast<std::uint32_t>(workers.size());
      worker.told_speed = group.speed;
      worker.speed = group.speed * (1 + farm.off * (2 * draw.fraction() - 1));
      workers.push_back(worker);
    }
  }
  return workers;
}

SimulationOptions options_of(std::span<const PlannedJob> jobs, const PlannedFarm& farm,
                             double triangles_per_s) {
  SimulationOptions options;
  options.faults.end = SimulatedTime(0);
  options.limit = std::chrono::hours(24 * 365);
  options.heartbeat = FarmTime(1000);
  options.network = {simulated(farm.delay_s), simulated(farm.delay_s / 2)};
  options.storage = {simulated(farm.file_s), farm.server_bytes_per_s, farm.link_bytes_per_s};
  options.centre = {simulated(farm.message_s), simulated(farm.result_s), true};
  options.schedule.schedule = farm.schedule;
  options.triangles_per_s = triangles_per_s;
  options.workers = workers_of(farm);
  options.schedule.expect_workers = static_cast<std::uint32_t>(options.workers.size());
  options.work = [jobs](const Job& job) {
    const PlannedJob& each = jobs[std::stoul(job.parameters)];
    return SimulatedWork{each.compute_s, each.read_bytes, each.written_bytes};
  };
  return options;
}

}  // namespace

std::vector<PlannedJob> planned_jobs(const Trace& trace) {
  std::map<std::uint32_t, Speed> speeds;
  for (const TraceDone& each : trace.done) {
    Speed& speed = speeds[each.worker];
    speed.triangles += static_cast<double>(each.triangles);
    speed.seconds += compute_s(each);
  }
  double fastest = 0;
  for (const auto& [worker, speed] : speeds) fastest = std::max(fastest, speed.value());
  std::vector<PlannedJob> jobs;
  std::set<std::uint64_t> known;
  for (const TraceDone& each : trace.done) {
    if (!known.insert(each.job).second) continue;
    const double relative = fastest > 0 ? speeds.at(each.worker).value() / fastest : 1;
    jobs.push_back({each.round, each.triangles, each.read_bytes, each.written_bytes,
                    compute_s(each) * relative});
  }
  if (jobs.empty()) throw DataError("the trace has no job that was done");
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const PlannedJob& a, const PlannedJob& b) { return a.round < b.round; });
  return jobs;
}

std::vector<PlannedJob> as_parts(std::span<const PlannedJob> jobs, std::uint64_t count) {
  const double share = static_cast<double>(jobs.size()) / static_cast<double>(count);
  const auto of = [&](std::uint64_t value) {
    return static_cast<std::uint64_t>(static_cast<double>(value) * share);
  };
  std::vector<PlannedJob> parts;
  for (std::uint64_t i = 0; i < count; ++i) {
    const PlannedJob& like = jobs[static_cast<std::size_t>(static_cast<double>(i) * share)];
    parts.push_back({like.round, of(like.triangles), of(like.read_bytes), of(like.written_bytes),
                     like.compute_s * share});
  }
  return parts;
}

std::vector<PlannedJob> drawn(std::span<const PlannedJob> jobs, std::uint64_t count,
                              std::uint64_t seed) {
  std::map<std::uint32_t, double> work;
  for (const PlannedJob& job : jobs) work[job.round] += job.compute_s;
  const auto heaviest = std::max_element(
      work.begin(), work.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<PlannedJob> from;
  std::copy_if(jobs.begin(), jobs.end(), std::back_inserter(from),
               [&](const PlannedJob& job) { return job.round == heaviest->first; });
  Draw draw(seed);
  std::vector<PlannedJob> sample;
  for (std::uint64_t i = 0; i < count; ++i) sample.push_back(from[draw.next() % from.size()]);
  return sample;
}

PlannedRun simulate_run(std::span<const PlannedJob> jobs, const PlannedFarm& farm) {
  PlannedRun run;
  double triangles = 0;
  for (const PlannedJob& job : jobs) {
    run.work_s += job.compute_s;
    triangles += static_cast<double>(job.triangles);
  }
  const SimulationOptions options = options_of(jobs, farm, triangles / run.work_s);
  double speed = 0;
  for (const SimulatedWorker& worker : options.workers) speed += worker.speed;
  run.ideal_s = run.work_s / speed;
  const SimulationResult result = simulate_farm(source_of(jobs), options);
  if (!result.ended || !result.broken.empty() || !result.failure.empty()) {
    throw Error("the simulated run did not come to its end: " + result.broken + result.failure);
  }
  run.farm_s = seconds(result.last_accept - result.first_push);
  run.storage_busy = run.farm_s > 0 ? std::min(1.0, result.server_busy_s / run.farm_s) : 0;
  return run;
}

}  // namespace meshfarm
