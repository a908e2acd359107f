// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bake_plan.hpp"
#include "pipeline/compose_plan.hpp"
#include "pipeline/part_jobs.hpp"
#include "pipeline/sort_plan.hpp"

namespace meshfarm {
namespace {

/// A ladder begins at this many times the part's even share, so that a part of much detail can keep
/// more than its share; a part that deserves still more is asked for again.
constexpr double k_first_headroom = 4;
constexpr double k_more_headroom = 8;

/// Points of the input by which the error of the result is measured: the RMS of as many varies by
/// less than one per cent.
constexpr double k_error_samples = 100'000;
/// A bound is on the greatest distance, which more points find more of, vertices most.
constexpr double k_bound_samples = 200'000;

/// Parts that their topology holds back are to have no more of all triangles than this at the level
/// that is chosen, and all together no more than so many times what is wanted: one level is 1.6.
constexpr double k_fair_share = 0.1;
constexpr double k_fair_excess = 2;

/// What is thought of as a finer level has so many times the triangles, and is so near.
constexpr double k_finer = 1.2;
constexpr std::int32_t k_most_finer = 6;

/// What a run knows after some of its rounds: derived from the accepted outputs alone, so that
/// ventilator and sink, restarted or not, agree.
class Rounds {
 public:
  Rounds(const Manifest& manifest, const RunOptions& options, std::span<const AcceptedJob> accepted)
      : manifest_(manifest),
        options_(options),
        part_jobs_(manifest, options),
        topology_(first_topology()),
        headroom_(manifest.parts.size(), k_first_headroom),
        results_(manifest.parts.size()),
        files_(manifest.parts.size()) {
    ask_first();
    if (asked_.empty()) begin_sweeps();
    while (!asked_.empty() && accepted.size() >= asked_.size()) {
      take(accepted.first(asked_.size()));
      accepted = accepted.subspan(asked_.size());
      swept_ ? sweep_again() : ask_again();
      if (!swept_ && asked_.empty()) begin_sweeps();
    }
    if (asked_.empty()) compose(accepted);
  }

  /// The jobs of the round that is not accepted yet.
  std::vector<Job> jobs() const {
    std::vector<Job> jobs = compose_jobs_;
    for (const std::uint32_t part : asked_) {
      jobs.push_back(swept_ ? part_jobs_.sweep(part, sweep_levels_[part], topology_)
                            : part_jobs_.climb(part, headroom_[part], topology_));
    }
    return jobs;
  }

  ChosenRungs chosen() const {
    if (!jobs().empty()) throw Error("rungs are chosen before all parts are accepted");
    ChosenRungs chosen;
    for (const ComposedStreams& each : composed_) chosen.rungs.push_back(each.chosen);
    add_finer(chosen);
    chosen.kept = topology_ == TopologyMode::simplify ? kept_ : chosen.rungs;
    chosen.topology =
        topology_ == TopologyMode::keep_while_fair ? TopologyMode::automatic : topology_;
    chosen.rest = rest_;
    return chosen;
  }

 private:
  /// Which may turn out not to be fair.
  TopologyMode first_topology() const {
    if (options_.lines.topology != TopologyMode::automatic) return options_.lines.topology;
    if (part_jobs_.by_error()) return TopologyMode::keep;
    return options_.allocation == Allocation::threshold ? TopologyMode::keep_while_fair
                                                        : TopologyMode::automatic;
  }

  void ask_first() {
    for (std::uint32_t p = 0; p < manifest_.parts.size(); ++p) {
      if (!part_jobs_.is_sampled(p) || part_jobs_.climbs_samples()) asked_.push_back(p);
    }
  }

  void begin_sweeps() {
    swept_ = true;
    sweep_levels_.assign(results_.size(), level_);
    for (std::uint32_t p = 0; p < results_.size(); ++p) {
      if (!part_jobs_.is_sampled(p)) continue;
      if (part_jobs_.by_error()) sweep_levels_[p] = results_[p].rungs.back().level;
      asked_.push_back(p);
    }
  }

  void take(std::span<const AcceptedJob> round) {
    for (std::size_t i = 0; i < round.size(); ++i) {
      const std::uint32_t part = asked_[i];
      const JobOutput& output = round[i].output;
      results_[part] = decode_summary(output.summary, "summary of " + output.file.name);
      files_[part] = output.file;
      if (!swept_ && part_jobs_.is_sampled(part)) stand_for_stream(part);
    }
  }

  /// As many triangles as there would be of the whole stream.
  void stand_for_stream(std::uint32_t part) {
    const double times =
        static_cast<double>(manifest_.parts[part].triangles) /
        static_cast<double>(std::max<std::uint64_t>(1, manifest_.samples[part].triangles));
    for (Rung& rung : results_[part].rungs) {
      rung.free_triangles =
          static_cast<std::uint64_t>(times * static_cast<double>(rung.free_triangles));
    }
  }

  /// Where too few triangles are left for the target, or a stream is too far from what it was.
  void sweep_again() {
    const std::vector<std::uint32_t> swept = std::exchange(asked_, {});
    if (part_jobs_.by_error()) {
      for (const std::uint32_t part : swept) {
        if (!swept_too_far(part) || sweep_levels_[part] < 0) continue;
        --sweep_levels_[part];
        asked_.push_back(part);
      }
    } else if (part_jobs_.climbs_samples() && level_ >= 0 &&
               free_triangles(level_) < part_jobs_.target()) {
      --level_;
      sweep_levels_.assign(results_.size(), level_);
      asked_ = swept;
    }
  }

  std::uint64_t free_triangles(std::int32_t level) const {
    std::uint64_t sum = 0;
    for (const ResultSummary& result : results_) {
      sum += result.rungs[rung_at(result.rungs, level)].free_triangles;
    }
    return sum;
  }

  /// Of ladders: swept streams have one rung, and what was composed is none.
  void add_finer(ChosenRungs& chosen) const {
    if (part_jobs_.by_error() || composed_.size() != results_.size()) return;
    const std::uint64_t before = free_triangles(level_);
    for (std::int32_t level = level_ - 1; level >= level_ - k_most_finer; --level) {
      const auto triangles = static_cast<double>(free_triangles(level));
      if (triangles < k_finer * static_cast<double>(before)) continue;
      for (std::size_t p = 0; p < results_.size(); ++p) {
        chosen.finer.push_back({files_[p], rung_at(results_[p].rungs, level)});
      }
      chosen.times_finer = triangles / static_cast<double>(std::max<std::uint64_t>(1, before));
      return;
    }
  }

  /// What is to be stitched of each part, before anything is composed.
  std::vector<ComposedStreams> reached() const {
    std::vector<ComposedStreams> reached;
    for (std::size_t p = 0; p < results_.size(); ++p) {
      const ResultSummary& result = results_[p];
      const auto last = static_cast<std::uint32_t>(result.rungs.size() - 1);
      const std::uint32_t rung = part_jobs_.by_error() ? last : rung_at(result.rungs, level_);
      reached.push_back(
          {{files_[p], rung, 1, result.dropped_degenerate, result.dropped_duplicate, result.turned},
           result.rungs[rung].triangles,
           result.rungs[rung].free_triangles});
    }
    return reached;
  }

  void compose(std::span<const AcceptedJob> accepted) {
    const ComposeGoal goal{
        level_, part_jobs_.sweep_cost(level_), wanted(),
        topology_ == TopologyMode::simplify ? TopologyMode::simplify : TopologyMode::keep};
    ComposePlan plan(manifest_, options_, goal, reached());
    compose_jobs_ = plan.jobs();
    while (!compose_jobs_.empty() && accepted.size() >= compose_jobs_.size()) {
      plan.take(accepted.first(compose_jobs_.size()));
      accepted = accepted.subspan(compose_jobs_.size());
      compose_jobs_ = plan.jobs();
    }
    composed_ = plan.streams();
    rest_ = accepted;
  }

  /// Whether a stream was taken farther from what it was than it may be.
  bool swept_too_far(std::uint32_t stream) const {
    return results_[stream].rungs.front().error > k_error_share * options_.error.in(manifest_.box);
  }

  void ask_again() {
    asked_.clear();
    if (part_jobs_.by_error()) return;
    choose_level();
    if (topology_ == TopologyMode::keep_while_fair && is_unfair()) {
      keep_coarsest();
      topology_ = TopologyMode::simplify;
      headroom_.assign(headroom_.size(), k_first_headroom);
      ask_first();
      return;
    }
    if (options_.allocation == Allocation::uniform) return;
    for (std::uint32_t p = 0; p < results_.size(); ++p) {
      if (results_[p].rungs.front().level <= level_) continue;
      headroom_[p] *= k_more_headroom;
      asked_.push_back(p);
    }
  }

  /// Of what kept its topology, before it is given up. A sample of a stream tells nothing.
  void keep_coarsest() {
    for (std::uint32_t p = 0; p < results_.size(); ++p) {
      if (part_jobs_.is_sampled(p)) return kept_.clear();
      kept_.push_back({files_[p], static_cast<std::uint32_t>(results_[p].rungs.size() - 1)});
    }
  }

  double wanted() const {
    return provision(part_jobs_.ratio()) * static_cast<double>(part_jobs_.target());
  }

  void choose_level() {
    std::vector<std::vector<Rung>> ladders;
    for (const ResultSummary& result : results_) ladders.push_back(result.rungs);
    level_ = common_level(ladders, static_cast<std::uint64_t>(wanted()));
  }

  /// Whether parts that keep their topology could not follow the others to the common level, or all
  /// together not to the count, or whether not even all that they could do would meet the target.
  /// What is kept at too high a cost before that the finish finds out.
  bool is_unfair() const {
    double held = 0;
    double least = 0;
    bool any = false;
    for (const ResultSummary& result : results_) {
      const Rung& last = result.rungs.back();
      least += static_cast<double>(last.free_triangles);
      if (!result.held_by_topology) continue;
      any = true;
      if (last.level < level_) held += static_cast<double>(last.free_triangles);
    }
    const auto all = static_cast<double>(free_triangles(level_));
    if (any && least > static_cast<double>(part_jobs_.target())) return true;
    return held > k_fair_share * all || (any && all > k_fair_excess * wanted());
  }

  const Manifest& manifest_;
  const RunOptions& options_;
  PartJobs part_jobs_;
  TopologyMode topology_;  // of what is asked for
  std::vector<double> headroom_;
  std::vector<ResultSummary> results_;  // the last accepted, by part
  std::vector<FileRef> files_;
  std::vector<std::uint32_t> asked_;
  std::int32_t level_ = 0;
  bool swept_ = false;  // ladders are done, long streams are being swept
  std::vector<std::int32_t> sweep_levels_;
  std::vector<ChosenRung> kept_;
  std::vector<Job> compose_jobs_;  // of the round that is not accepted yet
  std::vector<ComposedStreams> composed_;
  std::span<const AcceptedJob> rest_;  // after what was composed
};

std::vector<Job> jobs_once_sorted(const Manifest& manifest, const RunOptions& options,
                                  std::span<const AcceptedJob> accepted) {
  const Rounds rounds(manifest, options, accepted);
  std::vector<Job> jobs = rounds.jobs();
  if (!jobs.empty() || !bakes_texture(manifest, options)) return jobs;
  const ChosenRungs chosen = rounds.chosen();
  return BakePlan(manifest, options, chosen, chosen.rest).jobs();
}

}  // namespace

double provision(double ratio) {
  return 1 + std::min(1.0, (1 - ratio) / (4 * ratio));
}

std::uint64_t samples_for(const Manifest& manifest, const RunOptions& options,
                          std::uint64_t triangles) {
  const double share = static_cast<double>(triangles) /
                       static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles()));
  const double all = options.error.value > 0 ? k_bound_samples : k_error_samples;
  return static_cast<std::uint64_t>(std::ceil(share * all));
}

std::uint32_t rung_at(std::span<const Rung> ladder, std::int32_t level) {
  std::uint32_t rung = 0;
  while (rung + 1 < ladder.size() && ladder[rung + 1].level <= level) ++rung;
  return rung;
}

std::int32_t common_level(std::span<const std::vector<Rung>> ladders, std::uint64_t wanted) {
  std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
  std::int32_t highest = std::numeric_limits<std::int32_t>::min();
  for (const std::vector<Rung>& ladder : ladders) {
    lowest = std::min(lowest, ladder.front().level);
    highest = std::max(highest, ladder.back().level);
  }
  for (std::int32_t level = highest; level > lowest; --level) {
    std::uint64_t free = 0;
    for (const std::vector<Rung>& ladder : ladders) {
      free += ladder[rung_at(ladder, level)].free_triangles;
    }
    if (free >= wanted) return level;
  }
  return lowest;
}

JobSource make_job_source(const Manifest& manifest, const RunOptions& options) {
  return [manifest, options](std::span<const AcceptedJob> accepted) {
    const SortPlan sorted(manifest, accepted);
    std::vector<Job> jobs = sorted.jobs();
    if (jobs.empty()) jobs = jobs_once_sorted(sorted.manifest(), options, sorted.rest());
    for (Job& job : jobs) job.algorithm = k_algorithm_version;
    return jobs;
  };
}

std::uint64_t memory_wanted(const Manifest& manifest, const RunOptions& options) {
  std::uint64_t wanted = 0;
  for (const Job& job : make_job_source(manifest, options)({})) {
    wanted = std::max(wanted, job.memory);
  }
  if (bakes_texture(manifest, options)) wanted = std::max(wanted, memory_of_bake(manifest));
  return manifest.sorting ? std::max(wanted, memory_wanted(as_if_sorted(manifest), options))
                          : wanted;
}

ChosenRungs choose_rungs(const Manifest& manifest, const RunOptions& options,
                         std::span<const AcceptedJob> accepted) {
  const SortPlan sorted(manifest, accepted);
  return Rounds(sorted.manifest(), options, sorted.rest()).chosen();
}

}  // namespace meshfarm
