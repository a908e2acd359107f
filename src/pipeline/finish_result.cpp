// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/finish_result.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/vertex_fit.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>
#include <meshfarm/util/stopwatch.hpp>

#include "pipeline/bounded_finish.hpp"
#include "pipeline/error_meter.hpp"
#include "pipeline/knee.hpp"
#include "pipeline/result_facing.hpp"

namespace meshfarm {
namespace {

class ResultFinish {
 public:
  ResultFinish(const Stage& stage, const Manifest& manifest, const RunOptions& run,
               const FinishResultOptions& options)
      : stage_(stage),
        manifest_(manifest),
        run_(run),
        lines_(lines_of(manifest, run)),
        options_(options) {
    summary_.manifest = manifest;
    summary_.target = asked_triangles(manifest, run);
    goal_ = target_triangles(manifest, run);
    summary_.max_error = run.error.in(manifest.box);
    summary_.dropped_degenerate = manifest.coincident_corners;
    summary_.dropped_duplicate = manifest.dropped_duplicate;
  }

  FinishedResult run(const ChosenRungs& chosen) {
    Stopwatch watch;
    lines_.topology = chosen.topology;
    for (const ChosenRung& each : chosen.rungs) {
      summary_.dropped_degenerate += each.dropped_degenerate;
      summary_.dropped_duplicate += each.dropped_duplicate;
      summary_.turned += each.turned;
    }
    std::vector<SurfaceSamples> samples;
    StitchedMesh stitched = stitch(chosen.rungs, samples);
    SplitSamples split = split_samples(std::move(samples), sample_counts(manifest_, run_));
    make_meter(std::move(split.measured));
    summary_.dropped_components = drop_small(stitched.mesh);
    summary_.stitched = stitched.mesh.triangles.size();
    summary_.stitch_seconds = watch.lap();
    Mesh result = summary_.max_error > 0 ? finish_within_bound(std::move(stitched))
                                         : finish(std::move(stitched));
    fit(result, split.fitting);
    count(result);
    compare_topology(chosen.kept, result);
    summary_.finish_seconds = watch.lap();
    tell("measure", 0, 0);
    summary_.error = meter_->measure(
        result, [&](const TriangleIndex& index) { count_crossings(index, result); });
    look_for_better(chosen);
    if (better_mesh_) take_better(chosen, result);
    describe(result);
    options_.check_stop();
    summary_.measure_seconds = watch.lap();
    return {std::move(result), std::move(summary_)};
  }

 private:
  void tell(std::string_view phase, double done, std::uint64_t triangles) const {
    options_.check_stop();
    options_.progress(phase, done, triangles);
  }

  ResultMesh read_part(const ChosenRung& chosen, std::size_t first_part) const {
    ResultMesh part =
        decode_rung(stage_.read(chosen.file, chosen.place.rung),
                    stage_.read(chosen.file, chosen.place.tail), chosen.rung, chosen.file.name);
    // For composed streams the stitcher checks this.
    if (chosen.parts == 1 &&
        part.boundary_vertices != manifest_.parts[first_part].boundary_vertices) {
      throw DataError(chosen.file.name + ": is not the result of part " +
                      std::to_string(first_part));
    }
    return part;
  }

  StitchedMesh stitch(const std::vector<ChosenRung>& chosen,
                      std::vector<SurfaceSamples>& samples) const {
    constexpr std::size_t k_read_at_once = 8;
    Stitcher stitcher(static_cast<std::uint32_t>(manifest_.parts.size()));
    std::vector<std::size_t> first_part = {0};
    for (const ChosenRung& each : chosen) first_part.push_back(first_part.back() + each.parts);
    for (std::size_t p = 0; p < chosen.size();) {
      std::vector<ResultMesh> parts(std::min(k_read_at_once, chosen.size() - p));
      parallel_for(parts.size(), 0, [&](std::uint64_t i) {
        parts[i] = read_part(chosen[p + i], first_part[p + i]);
      });
      for (ResultMesh& part : parts) {
        stitcher.add(part, chosen[p].parts);
        std::move(part.samples.begin(), part.samples.end(), std::back_inserter(samples));
        ++p;
      }
      tell("stitch", static_cast<double>(p) / static_cast<double>(chosen.size()), 0);
    }
    TriangleColumns columns;
    const auto boundary = read_boundary(stage_, manifest_.boundary, columns);
    columns.keep(lines_.columns);
    StitchedMesh stitched = stitcher.finish(boundary, columns);
    samples.push_back(samples_of_boundary(stitched.mesh, stitched.boundary_triangles));
    return stitched;
  }

  /// The boundary triangles, last in the stitched mesh, are still the input's.
  SurfaceSamples samples_of_boundary(Mesh& stitched, std::size_t count) const {
    Mesh boundary;
    boundary.triangles.assign(stitched.triangles.end() - static_cast<std::ptrdiff_t>(count),
                              stitched.triangles.end());
    std::swap(boundary.positions, stitched.positions);
    SurfaceSamples samples =
        sample_surface(boundary, {.samples = samples_for(manifest_, run_, count)});
    std::swap(boundary.positions, stitched.positions);
    return samples;
  }

  DroppedComponents drop_small(Mesh& stitched) const {
    return drop_small_components(stitched, run_.drop_components.in(manifest_.box));
  }

  void make_meter(std::vector<SurfaceSamples> samples) {
    meter_.emplace(stage_, manifest_, std::move(samples), options_.threads,
                   summary_.max_error > 0 ? k_points_for_bound : ErrorPoints{});
  }

  Mesh finish_within_bound(StitchedMesh stitched) {
    BoundedFinish finish =
        finish_to_bound(stage_, manifest_, std::move(stitched),
                        {.max_error = k_bound_share * summary_.max_error,
                         .certified_error = run_.certify ? summary_.max_error : 0,
                         .positions = manifest_.positions,
                         .lines = lines_,
                         .threads = options_.threads,
                         .progress = [&](std::uint64_t left) {
                           tell("finish, " + std::to_string(left) + " triangles", 0, 0);
                         }});
    summary_.dropped_degenerate += finish.dropped_degenerate;
    summary_.dropped_duplicate += finish.dropped_duplicate;
    summary_.turned += finish.turned;
    if (run_.certify) summary_.certified_error = summary_.max_error;
    return std::move(finish.mesh);
  }

  /// Reduces to this many triangles, or as few as possible.
  Simplifier reduced(StitchedMesh stitched, std::uint64_t target) const {
    const std::uint64_t before = stitched.mesh.triangles.size();
    SimplifyOptions options{.positions = manifest_.positions,
                            .opened = std::move(stitched.opened),
                            .lines = lines_,
                            .was_simplified = true};
    if (run_.finish == Finish::boundary) {
      options.seam = std::move(stitched.seam);
      options.lines.topology = TopologyMode::keep;
    }
    Simplifier simplifier(std::move(stitched.mesh), options);
    const auto reduce_to = [&](std::uint64_t triangles) {
      SimplifyGoal goal{.triangles = triangles};
      goal.keep_at = counts_before_knee(target);
      simplifier.reduce(goal, [&](std::uint64_t left) {
        const std::uint64_t all = before - std::min(before, triangles);
        const std::uint64_t done = before - std::min(before, left);
        tell("finish",
             all == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(all)),
             done);
        return true;
      });
    };
    reduce_to(target);
    // Sheets that are simplified in pairs may have left two or three triangles too many.
    if (simplifier.triangles() > target + 1) reduce_to(target);
    // A closed surface loses triangles in pairs: an odd target is missed by one fewer, not one
    // more.
    if (simplifier.triangles() == target + 1 && target > 0) reduce_to(target - 1);
    return simplifier;
  }

  Mesh finish(StitchedMesh stitched) {
    const std::uint64_t before = stitched.mesh.triangles.size();
    Simplifier simplifier = reduced(std::move(stitched), goal_);
    larger_ = simplifier.take_kept();
    summary_.dropped_degenerate += simplifier.dropped_degenerate();
    summary_.dropped_duplicate += simplifier.dropped_duplicate();
    summary_.turned += simplifier.turned();
    summary_.topology_simplified =
        lines_.topology == TopologyMode::simplify || simplifier.simplifies_topology();
    summary_.why_not_exact = why_not_exact(before, simplifier.mesh());
    Mesh result = simplifier.mesh();
    const bool may_mend = lines_.crossings == CrossingMode::avoid &&
                          run_.finish != Finish::boundary && !simplifier.pairs_sheets();
    if (may_mend) summary_.facing = mend(result);
    return result;
  }

  void fit(Mesh& result, std::vector<SurfaceSamples>& points) {
    if (points.empty()) return;
    tell("fit", 0, 0);
    summary_.fitted_vertices =
        fit_vertices(result, points, fit_options(lines_, manifest_.positions, 0, options_.threads));
    points = {};
  }

  FacingMended mend(Mesh& result) const {
    tell("facing", 0, 0);
    return mend_facing(result, *meter_, stage_, manifest_, options_.threads);
  }

  /// A topology that was kept need not be compared. `kept` has the input's topology, if there is
  /// any.
  void compare_topology(const std::vector<ChosenRung>& kept, const Mesh& result) {
    TopologyChange change;
    change.after = measure_topology(result);
    change.before = change.after;
    if (summary_.topology_simplified) {
      if (kept.empty()) return;
      tell("topology", 0, 0);
      std::vector<SurfaceSamples> unused;
      StitchedMesh stitched = stitch(kept, unused);
      drop_small(stitched.mesh);
      // Cleans the mesh as the finish does.
      const Simplifier cleaned(std::move(stitched.mesh), {.positions = manifest_.positions});
      change.before = measure_topology(cleaned.mesh());
      if (change.before.components > 1) {
        change.gone = find_gone_components(cleaned.mesh(), result, options_.threads);
      }
    }
    summary_.topology = change;
  }

  /// Finds out what slightly more triangles would have given: the finish may have gone too far, or
  /// the parts before it.
  void look_for_better(const ChosenRungs& chosen) {
    const double rms = summary_.error.greater().rms;
    if (!is_visible(rms / manifest_.box.diagonal())) return;
    for (const Mesh& mesh : larger_) tell_if_better(mesh, mesh.triangles.size());
    larger_ = {};
    if (summary_.better || chosen.finer.empty() || !is_plain(rms / manifest_.box.diagonal()))
      return;
    std::vector<SurfaceSamples> measured_already;
    StitchedMesh stitched = stitch(chosen.finer, measured_already);
    drop_small(stitched.mesh);
    const auto count =
        static_cast<std::uint64_t>(chosen.times_finer * static_cast<double>(summary_.triangles));
    if (!may_be_better(stitched.mesh, count)) return;
    const Simplifier simplifier = reduced(std::move(stitched), count);
    tell_if_better(simplifier.mesh(), simplifier.triangles());
  }

  void tell_if_better(const Mesh& mesh, std::uint64_t triangles) {
    if (!may_be_better(mesh, triangles)) return;
    const BetterCount better{triangles, meter_->measure(mesh)};
    if (!is_past_knee(made(), {triangles, better.error.greater().rms})) return;
    summary_.better = better;
    if (goal_ > summary_.target && is_a_little_more(goal_, triangles)) better_mesh_ = mesh;
  }

  /// The number asked for cannot be reached anyway, so the result is not ruined for it.
  void take_better(const ChosenRungs& chosen, Mesh& result) {
    result = std::move(*better_mesh_);
    summary_.fitted_vertices = 0;
    summary_.error = summary_.better->error;
    summary_.better.reset();
    count(result);
    compare_topology(chosen.kept, result);
    if (result.triangles.empty()) return;
    count_crossings(TriangleIndex(result, options_.threads), result);
  }

  /// Per triangle of the result this takes about as long as a run per two triangles of the input.
  void count_crossings(const TriangleIndex& index, const Mesh& result) {
    constexpr std::uint64_t k_always = 10'000;
    constexpr std::uint64_t k_of_input = 64;
    const std::uint64_t most = std::max(k_always, manifest_.triangles() / k_of_input);
    figures_.crossing_triangles.reset();
    figures_.crossings_skipped = "the result has more than a 64th of the input's triangles";
    if (result.triangles.size() > most) return;
    figures_.crossing_triangles = count_crossing_triangles(index, {.threads = options_.threads});
    figures_.crossings_skipped = figures_.crossing_triangles ? "" : k_too_many_at_one_place;
  }

  void count(const Mesh& result) {
    summary_.triangles = result.triangles.size();
    summary_.vertices = result.positions.size();
  }

  void describe(const Mesh& result) {
    ShapeMeter meter(options_.threads);
    meter.add(result.positions, result.triangles);
    figures_.shape = meter.measures();
    figures_.edges = measure_edge_lengths(result, options_.threads);
    figures_.is_closed = summary_.topology && summary_.topology->after.unmatched_edges == 0;
    summary_.result = figures_;
  }

  /// Estimates one direction only, which may be the smaller one: decides what to measure.
  bool may_be_better(const Mesh& mesh, std::uint64_t triangles) const {
    constexpr double k_doubt = 2;
    if (mesh.triangles.empty()) return false;
    const double rms = meter_->estimate_rms(DistanceMeter(mesh, options_.threads));
    return is_past_knee(made(), {triangles, rms / k_doubt});
  }

  CountAndError made() const { return {summary_.triangles, summary_.error.greater().rms}; }

  std::string why_not_exact(std::uint64_t before, const Mesh& result) const {
    const std::uint64_t after = result.triangles.size();
    if (after == summary_.target) return {};
    if (goal_ > summary_.target) {
      return "keeping the charts of its textures needs about that many";
    }
    if (summary_.target > before) return why_no_more();
    const Topology topology = measure_topology(result);
    if (after + 1 < summary_.target) return "pieces of a few triangles go as a whole";
    if (after < summary_.target) {
      return topology.border_edges == 0 ? "where no open border is left, triangles go in pairs"
                                        : "away from open borders, triangles go in pairs";
    }
    if (run_.finish == Finish::boundary) return "nothing more can be collapsed at the seams";
    // A closed piece has at least four triangles.
    if (after <= 4 * topology.components) {
      if (topology.components == 1) return "the last piece stays, and it can't be smaller";
      if (lines_.topology == TopologyMode::keep) {
        return "the topology is kept, and none of the " + std::to_string(topology.components) +
               " pieces can be smaller";
      }
    }
    std::string kept;
    if (run_.lines.topology == TopologyMode::keep) kept += "changing the topology, ";
    if (run_.lines.preserve_border) kept += "moving the borders, ";
    if (run_.lines.crease_angle > 0) kept += "moving the creases, ";
    if (lines_.columns.uvs) kept += "moving the borders of charts, ";
    if (lines_.columns.labels) kept += "moving the lines between labels, ";
    return "nothing more can be collapsed without " + kept +
           "turning a triangle over or making one of no area";
  }

  std::string why_no_more() const {
    const std::uint64_t dropped = summary_.dropped_degenerate + summary_.dropped_duplicate;
    if (summary_.dropped_components.components > 0) return "no more is left of the input";
    return summary_.target + dropped > manifest_.input_triangles
               ? "the input has no more"
               : "every part ends by itself at its share of the target";
  }

  const Stage& stage_;
  const Manifest& manifest_;
  const RunOptions& run_;
  LineOptions lines_;                // those the parts were made with
  std::optional<Mesh> better_mesh_;  // of summary_.better, if it is to be the result
  std::uint64_t goal_ = 0;           // triangles of the result
  const FinishResultOptions& options_;
  RunSummary summary_;
  std::vector<Mesh> larger_;  // earlier states of the result, with more triangles
  std::optional<ErrorMeter> meter_;
  SurfaceFigures figures_;  // of the result
};

}  // namespace

FinishedResult finish_result(const Stage& stage, const Manifest& manifest, const RunOptions& run,
                             const ChosenRungs& chosen, const FinishResultOptions& options) {
  return ResultFinish(stage, manifest, run, options).run(chosen);
}

}  // namespace meshfarm
