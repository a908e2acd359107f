// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A run from top to bottom: which jobs follow which. The stages' own files define how their jobs
// are made and how their outputs are used.
#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/run_graph.hpp>

#include "pipeline/bake_stage.hpp"
#include "pipeline/climb_stage.hpp"
#include "pipeline/compose_stage.hpp"
#include "pipeline/cut_stage.hpp"
#include "pipeline/finish_stage.hpp"
#include "pipeline/part_jobs.hpp"
#include "pipeline/part_results.hpp"
#include "pipeline/run_stages.hpp"
#include "pipeline/sort_stage.hpp"
#include "pipeline/sweep_stage.hpp"

namespace meshfarm {
namespace {

/// A level counts as finer if it has this many times the triangles, and is at most this many levels
/// away.
constexpr double k_finer = 1.2;
constexpr std::int32_t k_most_finer = 12;

/// Pieces are divided again once this many times the target is left, not counting seams: what is
/// locked from then on is about as simple as the result.
constexpr double k_before_finish = 1.02;
constexpr std::int32_t k_most_levels = 120;

class Run {
 public:
  using Parts = std::vector<std::uint32_t>;

  Run(Manifest manifest, RunOptions options)
      : options_(std::move(options)), state_{std::move(manifest), {}, {}, {}, {}} {}

  /// Cuts the input or sorts the slabs first, if needed; from then on the run is the same as for a
  /// stage of parts or streams.
  void begin(JobGraph& graph) {
    state_.why_finish_here = why_finish_here(manifest(), options_);
    if (manifest().cutting) {
      return cutting_.begin(graph, [this](JobGraph& so_far) { simplify(so_far); });
    }
    if (!manifest().sorting) return simplify(graph);
    graph.then(sorting_.ask(graph), [this](JobGraph& so_far) {
      state_.manifest.sorting.reset();
      simplify(so_far);
    });
  }
  const RunState& state() const { return state_; }

 private:
  /// Every part is climbed, and every long stream is swept.
  void simplify(JobGraph& graph) {
    simplifying_.emplace(manifest(), options_, cutting_.bundles(),
                         [this](std::uint32_t part) { return sorting_.sample_of(part); });
    const Parts all = parts_that([](std::uint32_t) { return true; });
    if (jobs().by_error()) return simplify_to_error(graph, all);
    if (!jobs().climbs_samples()) return simplify_to_ratio(graph);
    climb(graph, all);
  }

  /// Simplifies to a common level. For a long stream a sample is climbed, whose counts are scaled
  /// to the stream.
  void climb(JobGraph& graph, const Parts& parts) {
    graph.then(climbs().ask(graph, parts), [this, parts](JobGraph& so_far) {
      climbs().take(so_far, parts);
      cutting_.join(so_far, results(), [this](JobGraph& joined) { choose_level(joined); });
    });
  }

  void choose_level(JobGraph& graph) {
    const Parts again = climbs().choose_level();
    if (!again.empty()) return climb(graph, again);
    ladders_ = results().summaries;
    sweep(graph);
  }

  void sweep(JobGraph& graph) {
    const Parts streams = parts_that([this](std::uint32_t p) { return jobs().is_sampled(p); });
    if (streams.empty()) return compose(graph);
    const JobNeeds asked = sweeps().ask(graph, streams, results().level);
    graph.then(asked, [this, streams](JobGraph& so_far) {
      sweeps().take(so_far, streams);
      if (!sweeps().is_too_coarse()) return compose(so_far);
      --results().level;
      sweep(so_far);
    });
  }

  /// The same ratio in all parts needs no level.
  void simplify_to_ratio(JobGraph& graph) {
    const Parts streams = parts_that([this](std::uint32_t p) { return jobs().is_sampled(p); });
    const Parts parts = parts_that([this](std::uint32_t p) { return !jobs().is_sampled(p); });
    JobNeeds all = sweeps().ask(graph, streams, results().level);
    for (const JobRange& each : climbs().ask(graph, parts)) all.push_back(each);
    for (const std::uint32_t stream : streams) {
      for (const JobRange& each : sorting_.sample_of(stream)) all.push_back(each);
    }
    graph.then(all, [this, streams, parts](JobGraph& so_far) {
      sweeps().take(so_far, streams);
      climbs().take(so_far, parts);
      cutting_.join(so_far, results(), [this](JobGraph& joined) {
        climbs().choose_level();
        compose(joined);
      });
    });
  }

  /// Under a bound on the error each part is simplified independently.
  void simplify_to_error(JobGraph& graph, const Parts& parts) {
    if (parts.empty()) return compose(graph);
    for (const std::uint32_t part : parts) {
      graph.then(climbs().ask(graph, {part}), [this, part](JobGraph& so_far) {
        climbs().take(so_far, {part});
        if (!jobs().is_sampled(part)) return part_is_done(so_far);
        sweep_to_error(so_far, part, results().summaries[part].rungs.back().level);
      });
    }
  }

  void sweep_to_error(JobGraph& graph, std::uint32_t stream, std::int32_t level) {
    graph.then(sweeps().ask(graph, {stream}, level), [this, stream, level](JobGraph& so_far) {
      sweeps().take(so_far, {stream});
      if (!sweeps().is_too_far(stream) || level < 0) return part_is_done(so_far);
      sweep_to_error(so_far, stream, level - 1);
    });
  }

  void part_is_done(JobGraph& graph) {
    if (++parts_done_ < manifest().parts.size()) return;
    JobNeeds all;
    for (const JobName& job : results().made_by) all.push_back(just(job));
    graph.then(all, [this](JobGraph& so_far) {
      cutting_.join(so_far, results(), [this](JobGraph& joined) { compose(joined); });
    });
  }

  /// Workers join neighbours, if that is worth it.
  void compose(JobGraph& graph) {
    const ComposeGoal goal{
        results().level, jobs().sweep_cost(results().level), jobs().wanted(),
        results().topology == TopologyMode::simplify ? TopologyMode::simplify : TopologyMode::keep,
        state_.why_finish_here.empty()};
    composing_.begin(graph, goal, reached(),
                     [this, goal](JobGraph& so_far, const std::vector<ComposedParts>& parts) {
                       choose(parts);
                       if (state_.why_finish_here.empty()) return finish(so_far, goal, parts);
                       if (bakes_texture(manifest(), options_)) baking_.begin(so_far, *chosen());
                     });
  }

  /// Finishes in pieces; if the result can't be made that way, the sink makes it from the chosen
  /// rungs.
  void finish(JobGraph& graph, const ComposeGoal& goal, const std::vector<ComposedParts>& parts) {
    finishing_.begin(graph, finish_goal(goal.topology), parts,
                     [this](JobGraph&, std::optional<FinishedPieces> made, std::string why_here) {
                       state_.finished = std::move(made);
                       state_.why_finish_here = std::move(why_here);
                     });
  }

  /// Computed from the ladders; counts are assumed to fall evenly between levels. Counts from
  /// samples of streams are corrected by the results of the sweeps.
  FinishGoal finish_goal(TopologyMode topology) const {
    const double wanted =
        k_before_finish * static_cast<double>(target_triangles(manifest(), options_));
    std::int32_t level = std::max(0, results().level);
    const auto told = static_cast<double>(free_triangles_at(ladders_, level));
    const auto made = static_cast<double>(results().free_triangles(level));
    const double times = told > 0 ? made / told : 1;
    const auto at = [this, times](std::int32_t tried) {
      return times * static_cast<double>(free_triangles_at(ladders_, tried));
    };
    for (std::int32_t tried = 0; tried < k_most_levels && at(level + 1) > wanted; ++tried) ++level;
    const double before = at(level);
    const double after = at(level + 1);
    const double way = before > wanted && before > after ? (before - wanted) / (before - after) : 0;
    FinishGoal goal;
    goal.step =
        k_steps_a_level * level + static_cast<std::int32_t>(k_steps_a_level * std::min(1.0, way));
    goal.share = 1 / k_before_finish;
    goal.topology = topology;
    goal.may_simplify = options_.lines.topology == TopologyMode::automatic;
    return goal;
  }

  /// The rung of each part to stitch, before anything is composed.
  std::vector<ComposedParts> reached() const {
    std::vector<ComposedParts> reached;
    for (std::size_t p = 0; p < results().files.size(); ++p) {
      const ResultSummary& result = results().summaries[p];
      const auto last = static_cast<std::uint32_t>(result.rungs.size() - 1);
      const std::uint32_t rung = jobs().by_error() ? last : rung_at(result.rungs, results().level);
      reached.push_back({{results().files[p], rung, 1, result.dropped_degenerate,
                          result.dropped_duplicate, result.turned, place_of(result, rung)},
                         result.rungs[rung].triangles,
                         result.rungs[rung].free_triangles});
    }
    return reached;
  }

  /// The mesh is made: the sink may stitch it.
  void choose(const std::vector<ComposedParts>& parts) {
    ChosenRungs& chosen = state_.chosen.emplace();
    for (const ComposedParts& each : parts) chosen.rungs.push_back(each.chosen);
    add_finer(chosen);
    const TopologyMode topology = results().topology;
    chosen.kept = topology == TopologyMode::simplify ? climbs().kept() : chosen.rungs;
    chosen.topology =
        topology == TopologyMode::keep_while_fair ? TopologyMode::automatic : topology;
  }

  /// For ladders only: swept streams have one rung, and composed parts have no ladder.
  void add_finer(ChosenRungs& chosen) const {
    if (jobs().by_error() || chosen.rungs.size() != results().files.size()) return;
    const std::int32_t chosen_level = results().level;
    const std::uint64_t before = results().free_triangles_made(chosen_level);
    for (std::int32_t level = chosen_level - 1; level >= chosen_level - k_most_finer; --level) {
      const auto triangles = static_cast<double>(results().free_triangles_made(level));
      if (triangles < k_finer * static_cast<double>(before)) continue;
      for (std::size_t p = 0; p < results().files.size(); ++p) {
        const ResultSummary& result = results().summaries[p];
        const std::uint32_t rung = rung_at(result.rungs, level);
        chosen.finer.push_back(
            {.file = results().files[p], .rung = rung, .place = place_of(result, rung)});
      }
      chosen.times_finer = triangles / static_cast<double>(std::max<std::uint64_t>(1, before));
      return;
    }
  }

  /// Created once the slabs are sorted.
  struct Simplifying {
    Simplifying(const Manifest& manifest, const RunOptions& options, const BundlesOfMesh* bundles,
                std::function<JobNeeds(std::uint32_t)> sample_of)
        : jobs(manifest, options, bundles),
          results(manifest.parts.size()),
          climbs(manifest, options, jobs, results, std::move(sample_of)),
          sweeps(manifest, options, jobs, results) {}
    PartJobs jobs;
    PartResults results;
    ClimbStage climbs;
    SweepStage sweeps;
  };
  template <class Which>
  Parts parts_that(const Which& which) const {
    Parts parts(manifest().parts.size());
    std::iota(parts.begin(), parts.end(), 0U);
    std::erase_if(parts, [&](std::uint32_t part) { return !which(part); });
    return parts;
  }
  const Manifest& manifest() const { return state_.manifest; }
  const std::optional<ChosenRungs>& chosen() const { return state_.chosen; }
  const PartJobs& jobs() const { return simplifying_->jobs; }
  PartResults& results() { return simplifying_->results; }
  const PartResults& results() const { return simplifying_->results; }
  ClimbStage& climbs() { return simplifying_->climbs; }
  SweepStage& sweeps() { return simplifying_->sweeps; }

  RunOptions options_;
  RunState state_;
  CutStage cutting_{state_.manifest};
  SortStage sorting_{state_.manifest};
  std::optional<Simplifying> simplifying_;
  std::size_t parts_done_ = 0;
  std::vector<ResultSummary> ladders_;  // that the level was chosen by, by part
  ComposeStage composing_{state_.manifest, options_};
  FinishStage finishing_{state_.manifest, options_};
  BakeStage baking_{state_.manifest, options_, state_.baked};
};

std::pair<JobGraph, std::shared_ptr<const Run>> begin_run(const Manifest& manifest,
                                                          const RunOptions& options) {
  const auto run = std::make_shared<Run>(manifest, options);
  JobGraph graph = empty_graph(k_algorithm_version);
  run->begin(graph);
  graph.keep(run);
  return {std::move(graph), run};
}

}  // namespace

JobSource make_job_source(const Manifest& manifest, const RunOptions& options) {
  return [manifest, options] { return begin_run(manifest, options).first; };
}

RunState state_of_run(const Manifest& manifest, const RunOptions& options,
                      std::span<const AcceptedJob> accepted) {
  std::map<JobKey, const JobOutput*> outputs;
  for (const AcceptedJob& each : accepted) outputs[each.key] = &each.output;
  auto [graph, run] = begin_run(manifest, options);
  std::vector<WantedJob> jobs = graph.begin();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const auto found = outputs.find(jobs[i].key);
    if (found == outputs.end()) continue;
    for (WantedJob& each : graph.accept(jobs[i].key, *found->second)) {
      jobs.push_back(std::move(each));
    }
  }
  return run->state();
}

std::uint64_t memory_wanted(const Manifest& manifest, const RunOptions& options) {
  std::uint64_t wanted = 0;
  JobGraph graph = make_job_source(manifest, options)();
  for (const WantedJob& each : graph.begin()) wanted = std::max(wanted, each.job.memory);
  if (bakes_texture(manifest, options)) wanted = std::max(wanted, memory_of_bake(manifest));
  if (manifest.cutting) {
    wanted = std::max(wanted, memory_of_cut(manifest));
    return std::max(wanted, memory_wanted(as_if_cut(manifest), options));
  }
  return manifest.sorting ? std::max(wanted, memory_wanted(as_if_sorted(manifest), options))
                          : wanted;
}

}  // namespace meshfarm
