// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/pipeline/planning.hpp>
#include <meshfarm/simulation/simulation.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Minimum time of a job in seconds: the trace counts in milliseconds.
constexpr double k_least_compute_s = 100e-6;

SimulatedTime simulated(double seconds) {
  return SimulatedTime(static_cast<std::int64_t>(seconds * 1e6));
}

double seconds(SimulatedTime time) {
  return std::chrono::duration<double>(time).count();
}

/// Prefers processor time, as the trace's host may have been busy with other things.
double compute_s(const TraceDone& job) {
  if (job.cpu_us > 0) return static_cast<double>(job.cpu_us) * 1e-6;
  return std::max(k_least_compute_s, job.compute_ms / 1000.0);
}

struct Speed {
  double triangles = 0;
  double seconds = 0;
  double value() const { return seconds > 0 ? triangles / seconds : 0; }
};

/// Knuth's 64-bit linear congruential generator: the same draw on every machine.
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

using Needs = std::vector<PlannedJob::Range>;

/// For jobs sorted by depth.
Needs needs_of(std::span<const PlannedJob> jobs, const PlannedJob& job) {
  if (!job.needs.empty() || job.depth == 0) return job.needs;
  const auto end = std::partition_point(
      jobs.begin(), jobs.end(), [&](const PlannedJob& each) { return each.depth < job.depth; });
  return {{0, static_cast<std::size_t>(end - jobs.begin())}};
}

using ByNeeds = std::map<Needs, std::vector<std::uint32_t>>;

/// For each job the longest chain of jobs after it.
std::vector<std::uint64_t> work_after(std::span<const PlannedJob> jobs, const ByNeeds& by_needs) {
  std::vector<const ByNeeds::value_type*> deepest_first;
  for (const auto& each : by_needs) deepest_first.push_back(&each);
  std::stable_sort(deepest_first.begin(), deepest_first.end(), [&](const auto* a, const auto* b) {
    return jobs[a->second.front()].depth > jobs[b->second.front()].depth;
  });
  std::vector<std::uint64_t> after(jobs.size());
  for (const auto* group : deepest_first) {
    std::uint64_t longest = 0;
    for (const std::uint32_t place : group->second) {
      longest = std::max(longest, jobs[place].triangles + after[place]);
    }
    for (const PlannedJob::Range& each : group->first) {
      for (std::size_t i = each.first; i < each.end; ++i) after[i] = std::max(after[i], longest);
    }
  }
  return after;
}

/// Jobs are named by their place.
JobSource source_of(std::span<const PlannedJob> jobs, const PlannedFarm& farm) {
  const auto by_needs = std::make_shared<ByNeeds>();
  for (std::uint32_t i = 0; i < jobs.size(); ++i) {
    (*by_needs)[needs_of(jobs, jobs[i])].push_back(i);
  }
  const auto add = [jobs, keeps = farm.cache_bytes > 0, after = work_after(jobs, *by_needs)](
                       JobGraph& graph, const std::vector<std::uint32_t>& places) {
    for (const std::uint32_t place : places) {
      Job job;
      job.kind = jobs[place].kind;
      job.parameters = std::to_string(place);
      job.cost = jobs[place].triangles;
      job.after = after[place];
      job.left_to_readers = jobs[place].left_to_readers;
      if (keeps) job.extent = jobs[place].extent;
      graph.add({0, place}, std::move(job));
    }
  };
  return [by_needs, add] {
    JobGraph graph({"planned"});
    graph.keep(by_needs);
    for (const auto& [ranges, places] : *by_needs) {
      JobNeeds needs;
      for (const PlannedJob::Range& each : ranges) {
        needs.push_back({0, static_cast<std::uint32_t>(each.first),
                         static_cast<std::uint32_t>(each.end - each.first)});
      }
      graph.then(needs, [&places = places, add](JobGraph& so_far) { add(so_far, places); });
    }
    return graph;
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
  options.storage = {simulated(farm.file_s), farm.server_bytes_per_s, farm.link_bytes_per_s,
                     static_cast<std::uint64_t>(farm.cache_bytes)};
  options.centre = {simulated(farm.message_s), simulated(farm.result_s), true};
  options.schedule.schedule = farm.schedule;
  options.triangles_per_s = triangles_per_s;
  options.workers = workers_of(farm);
  options.schedule.expect_workers = static_cast<std::uint32_t>(options.workers.size());
  options.work = [jobs](const Job& job) {
    const PlannedJob& each = jobs[std::stoul(job.parameters)];
    return SimulatedWork{each.compute_s, each.read_bytes, each.written_bytes, each.extent};
  };
  return options;
}

/// Jobs of a trace; each comes after those that it needs.
class TracedJobs {
 public:
  void add(const TraceDone& done, double seconds) {
    const std::uint32_t depth = done.stage.empty() ? done.round : depth_of(done.needs);
    places_[done.stage][done.index] = jobs_.size();
    jobs_.push_back({{depth,
                      done.triangles,
                      done.read_bytes,
                      done.written_bytes,
                      seconds,
                      {},
                      done.stage,
                      done.kind,
                      is_left_to_readers(done.kind),
                      {done.extent, done.extent_bytes}},
                     &done});
  }

  std::vector<PlannedJob> sorted() {
    if (jobs_.empty()) throw DataError("the trace has no job that was done");
    std::vector<std::size_t> order(jobs_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return jobs_[a].planned.depth < jobs_[b].planned.depth;
    });
    std::vector<std::size_t> place_of(jobs_.size());
    for (std::size_t i = 0; i < order.size(); ++i) place_of[order[i]] = i;
    std::vector<PlannedJob> sorted;
    for (const std::size_t each : order) {
      sorted.push_back(jobs_[each].planned);
      sorted.back().needs = ranges_of(jobs_[each].done->needs, place_of);
    }
    return sorted;
  }

 private:
  struct Traced {
    PlannedJob planned;
    const TraceDone* done = nullptr;
  };
  using Ranges = std::vector<TraceDone::Needs>;
  using Words = std::vector<std::tuple<std::string, std::uint32_t, std::uint32_t>>;

  /// Jobs that are not in the trace were done before, or are the sink's.
  template <class Visit>
  void visit(const Ranges& needs, const Visit& visit) const {
    for (const TraceDone::Needs& each : needs) {
      const auto stage = places_.find(each.stage);
      if (stage == places_.end()) continue;
      for (auto at = stage->second.lower_bound(each.first);
           at != stage->second.end() && at->first - each.first < each.count; ++at) {
        visit(at->second);
      }
    }
  }

  static Words words_of(const Ranges& needs) {
    Words words;
    for (const TraceDone::Needs& each : needs) {
      words.emplace_back(each.stage, each.first, each.count);
    }
    return words;
  }

  /// Many jobs need the same ranges: these are looked through only once.
  std::uint32_t depth_of(const Ranges& needs) {
    const auto [depth, is_new] = depths_.try_emplace(words_of(needs));
    if (is_new) {
      visit(needs, [&, &most = depth->second](std::size_t job) {
        most = std::max(most, jobs_[job].planned.depth + 1);
      });
    }
    return depth->second;
  }

  Needs ranges_of(const Ranges& needs, const std::vector<std::size_t>& place_of) {
    const auto [ranges, is_new] = ranges_.try_emplace(words_of(needs));
    if (!is_new) return ranges->second;
    std::vector<std::size_t> places;
    visit(needs, [&](std::size_t job) { places.push_back(place_of[job]); });
    std::sort(places.begin(), places.end());
    for (const std::size_t place : places) {
      const bool joins = !ranges->second.empty() && place <= ranges->second.back().end;
      if (!joins) ranges->second.push_back({place, place});
      ranges->second.back().end = place + 1;
    }
    return ranges->second;
  }

  std::vector<Traced> jobs_;
  std::map<std::string, std::map<std::uint32_t, std::size_t>> places_;  // by stage and index
  std::map<Words, std::uint32_t> depths_;
  std::map<Words, Needs> ranges_;
};

/// The jobs of the depth with the most work. `jobs` are sorted by depth.
PlannedJob::Range heaviest_depth(std::span<const PlannedJob> jobs) {
  PlannedJob::Range heaviest;
  double most = -1;
  for (std::size_t first = 0; first < jobs.size();) {
    std::size_t end = first;
    double work = 0;
    for (; end < jobs.size() && jobs[end].depth == jobs[first].depth; ++end) {
      work += jobs[end].compute_s;
    }
    if (work > most) heaviest = {first, end};
    most = std::max(most, work);
    first = end;
  }
  return heaviest;
}

}  // namespace

std::vector<PlannedJob> planned_jobs(const Trace& trace) {
  std::map<std::uint32_t, Speed> speeds;
  for (const TraceDone& each : trace.done) {
    if (each.worker == k_sink_of_trace) continue;
    Speed& speed = speeds[each.worker];
    speed.triangles += static_cast<double>(each.triangles);
    speed.seconds += compute_s(each);
  }
  double fastest = 0;
  for (const auto& [worker, speed] : speeds) fastest = std::max(fastest, speed.value());
  TracedJobs traced;
  std::set<std::uint64_t> known;
  for (const TraceDone& each : trace.done) {
    if (!known.insert(each.job).second) continue;
    const bool scales = fastest > 0 && each.worker != k_sink_of_trace;
    const double relative = scales ? speeds.at(each.worker).value() / fastest : 1;
    traced.add(each, compute_s(each) * relative);
  }
  return traced.sorted();
}

std::vector<PlannedJob> as_parts(std::span<const PlannedJob> jobs, std::uint64_t count) {
  const PlannedJob::Range heaviest = heaviest_depth(jobs);
  const std::size_t old_count = heaviest.end - heaviest.first;
  const double share = static_cast<double>(old_count) / static_cast<double>(count);
  const auto of = [&](std::uint64_t value) {
    return static_cast<std::uint64_t>(static_cast<double>(value) * share);
  };
  // Jobs that needed old ones need the new ones that have the same work.
  const auto place_of = [&](std::size_t place, std::size_t rounding) {
    if (place <= heaviest.first) return place;
    if (place >= heaviest.end) return place + count - old_count;
    return heaviest.first + ((place - heaviest.first) * count + rounding) / old_count;
  };
  const auto moved = [&](PlannedJob job) {
    for (PlannedJob::Range& range : job.needs) {
      range = {place_of(range.first, 0), place_of(range.end, old_count - 1)};
    }
    return job;
  };
  std::vector<PlannedJob> parts;
  for (std::size_t i = 0; i < heaviest.first; ++i) parts.push_back(jobs[i]);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto like = heaviest.first + static_cast<std::size_t>(static_cast<double>(i) * share);
    PlannedJob& part = parts.emplace_back(jobs[like]);
    part.triangles = of(part.triangles);
    part.read_bytes = of(part.read_bytes);
    part.written_bytes = of(part.written_bytes);
    part.compute_s *= share;
    part.extent = {};
  }
  for (std::size_t i = heaviest.end; i < jobs.size(); ++i) parts.push_back(moved(jobs[i]));
  return parts;
}

std::vector<PlannedJob> drawn(std::span<const PlannedJob> jobs, std::uint64_t count,
                              std::uint64_t seed) {
  const PlannedJob::Range heaviest = heaviest_depth(jobs);
  const auto from = jobs.subspan(heaviest.first, heaviest.end - heaviest.first);
  Draw draw(seed);
  std::vector<PlannedJob> sample;
  for (std::uint64_t i = 0; i < count; ++i) {
    sample.push_back(from[draw.next() % from.size()]);
    sample.back().needs.clear();
    sample.back().extent = {};
  }
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
  const SimulationResult result = simulate_farm(source_of(jobs, farm), options);
  if (!result.ended || !result.broken.empty() || !result.failure.empty()) {
    throw Error("the simulated run did not come to its end: " + result.broken + result.failure);
  }
  run.accepted_s = seconds(result.last_accept - result.first_push);
  run.farm_s = seconds(std::max(result.last_accept, result.last_verified) - result.first_push);
  run.storage_s = result.server_busy_s;
  run.storage_busy = run.farm_s > 0 ? std::min(1.0, run.storage_s / run.farm_s) : 0;
  return run;
}

std::vector<PlannedStage> simulate_stages(std::span<const PlannedJob> jobs,
                                          const PlannedFarm& farm) {
  double speed = 0;
  for (const WorkerGroup& group : farm.groups) {
    speed += static_cast<double>(group.count) * group.speed;
  }
  std::vector<PlannedStage> stages;
  PlannedRun before;
  for (std::size_t first = 0, end = 0; first < jobs.size(); first = end) {
    PlannedStage& stage = stages.emplace_back();
    std::map<std::string, double> work;  // per stage, of jobs that are done side by side
    for (; end < jobs.size() && jobs[end].depth == jobs[first].depth; ++end) {
      const PlannedJob& job = jobs[end];
      work[job.stage] += job.compute_s;
      ++stage.jobs;
      stage.ideal_s += job.compute_s / speed;
      stage.longest_s = std::max(stage.longest_s, job.compute_s);
    }
    stage.name = std::max_element(work.begin(), work.end(), [](const auto& a, const auto& b) {
                   return a.second < b.second;
                 })->first;
    const PlannedRun so_far = simulate_run(jobs.first(end), farm);
    stage.storage_s = std::max(0.0, so_far.storage_s - before.storage_s);
    stage.takes_s = std::max(0.0, so_far.accepted_s - before.accepted_s);
    before = so_far;
  }
  return stages;
}

}  // namespace meshfarm
