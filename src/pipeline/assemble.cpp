// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/simplify_within.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "pipeline/error_meter.hpp"
#include "pipeline/sort_plan.hpp"

namespace meshfarm {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

class Assembly {
 public:
  Assembly(const Stage& stage, const Manifest& manifest, const RunOptions& run,
           const AssembleOptions& options)
      : stage_(stage), manifest_(manifest), run_(run), lines_(run.lines), options_(options) {
    summary_.manifest = manifest;
    summary_.output = options.output.string();
    summary_.target = target_triangles(manifest, run);
    summary_.max_error = run.error.in(manifest.box);
    summary_.dropped_degenerate = manifest.dropped_degenerate;
    summary_.dropped_duplicate = manifest.dropped_duplicate;
  }

  RunSummary run(std::span<const AcceptedJob> accepted) {
    Stopwatch watch;
    const ChosenRungs chosen = choose_rungs(manifest_, run_, accepted);
    lines_.topology = chosen.topology;
    StitchedMesh stitched = stitch(chosen.rungs);
    make_meter();
    summary_.dropped_components =
        drop_small_components(stitched.mesh, run_.drop_components.in(manifest_.box));
    summary_.stitched = stitched.mesh.triangles.size();
    summary_.stitch_seconds = watch.lap();
    const Mesh result = summary_.max_error > 0 ? finish_to_bound(std::move(stitched.mesh))
                                               : finish(std::move(stitched));
    summary_.triangles = result.triangles.size();
    summary_.vertices = result.positions.size();
    summary_.finish_seconds = watch.lap();
    tell("measure", 0, 0);
    summary_.error = meter_->measure(result);
    check_stop();
    summary_.measure_seconds = watch.lap();
    write_ply(options_.output, result, manifest_.positions);
    summary_.write_seconds = watch.lap();
    return std::move(summary_);
  }

 private:
  void tell(std::string_view phase, double done, std::uint64_t triangles) const {
    check_stop();
    if (options_.progress) options_.progress(phase, done, triangles);
  }

  void check_stop() const {
    if (options_.stop != nullptr && *options_.stop) {
      throw IncompleteError(
          "interrupted before the result was written; all parts are simplified, "
          "'meshfarm replay' or 'meshfarm run' on the stage goes on from there");
    }
  }

  ResultMesh read_part(const ChosenRung& chosen, std::size_t first_part) const {
    const std::string file = stage_.read(chosen.file);
    ResultMesh part = decode_result(file, chosen.rung, chosen.file.name);
    // Of composed streams the stitcher knows.
    if (chosen.parts == 1 &&
        part.boundary_vertices != manifest_.parts[first_part].boundary_vertices) {
      throw DataError(chosen.file.name + ": is not the result of part " +
                      std::to_string(first_part));
    }
    return part;
  }

  StitchedMesh stitch(const std::vector<ChosenRung>& chosen) {
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
        summary_.dropped_degenerate += chosen[p].dropped_degenerate;
        summary_.dropped_duplicate += chosen[p].dropped_duplicate;
        std::move(part.samples.begin(), part.samples.end(), std::back_inserter(samples_));
        ++p;
      }
      tell("stitch", static_cast<double>(p) / static_cast<double>(chosen.size()), 0);
    }
    const auto boundary = decode_boundary(stage_.read(manifest_.boundary), manifest_.boundary.name);
    StitchedMesh stitched = stitcher.finish(boundary);
    sample_boundary(stitched.mesh, stitched.boundary_triangles);
    return stitched;
  }

  /// The boundary triangles, last in the stitched mesh, are still those of the input.
  void sample_boundary(Mesh& stitched, std::size_t count) {
    Mesh boundary;
    boundary.triangles.assign(stitched.triangles.end() - static_cast<std::ptrdiff_t>(count),
                              stitched.triangles.end());
    std::swap(boundary.positions, stitched.positions);
    samples_.push_back(sample_surface(boundary, {.samples = samples_for(manifest_, run_, count)}));
    std::swap(boundary.positions, stitched.positions);
  }

  void make_meter() {
    meter_.emplace(stage_, manifest_, std::move(samples_), options_.threads,
                   summary_.max_error > 0 ? k_points_for_bound : ErrorPoints{});
  }

  Mesh finish_to_bound(Mesh stitched) {
    // Between the points that are measured a surface may be a little farther.
    constexpr double k_bound_margin = 0.92;
    BoundedSimplifier simplifier(
        std::move(stitched), {.positions = manifest_.positions, .lines = lines_},
        [&](const Mesh& mesh) {
          tell("finish, " + std::to_string(mesh.triangles.size()) + " triangles", 0, 0);
          return meter_->strays(mesh, k_bound_margin * summary_.max_error);
        });
    summary_.dropped_degenerate += simplifier.dropped_degenerate();
    summary_.dropped_duplicate += simplifier.dropped_duplicate();
    constexpr double k_last_step = 2;
    if (simplifier.accept_strays()) reduce_to_bound(simplifier, k_last_step);
    return simplifier.mesh();
  }

  Mesh finish(StitchedMesh stitched) {
    const std::uint64_t before = stitched.mesh.triangles.size();
    SimplifyOptions options{.positions = manifest_.positions, .lines = lines_};
    if (run_.finish == Finish::boundary) {
      options.seam = std::move(stitched.seam);
      options.lines.topology = TopologyMode::keep;
    }
    Simplifier simplifier(std::move(stitched.mesh), std::move(options));
    const auto reduce_to = [&](std::uint64_t triangles) {
      simplifier.reduce({.triangles = triangles}, [&](std::uint64_t left) {
        const std::uint64_t all = before - std::min(before, triangles);
        const std::uint64_t done = before - std::min(before, left);
        tell("finish",
             all == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(all)),
             done);
        return true;
      });
    };
    reduce_to(summary_.target);
    // A closed surface loses triangles in pairs: of an odd target one fewer is taken, not one more.
    if (simplifier.triangles() == summary_.target + 1 && summary_.target > 0) {
      reduce_to(summary_.target - 1);
    }
    summary_.dropped_degenerate += simplifier.dropped_degenerate();
    summary_.dropped_duplicate += simplifier.dropped_duplicate();
    summary_.topology_simplified =
        lines_.topology == TopologyMode::simplify || simplifier.simplifies_topology();
    summary_.why_not_exact = why_not_exact(before, simplifier.triangles());
    return simplifier.mesh();
  }

  std::string why_not_exact(std::uint64_t before, std::uint64_t after) const {
    if (after == summary_.target) return {};
    if (summary_.target > before) {
      return summary_.dropped_components.components == 0 ? "the input has no more"
                                                         : "no more is left of the input";
    }
    if (after < summary_.target) {
      return "where no open border is left, triangles go in pairs";
    }
    if (run_.finish == Finish::boundary) return "nothing more can be collapsed at the seams";
    std::string kept;
    if (run_.lines.topology == TopologyMode::keep) kept += "changing the topology, ";
    if (run_.lines.preserve_border) kept += "moving the borders, ";
    if (run_.lines.crease_angle > 0) kept += "moving the creases, ";
    if (!kept.empty()) kept.replace(kept.size() - 2, 2, " or ");
    return "nothing more can be collapsed without " + kept + "turning a triangle over";
  }

  const Stage& stage_;
  const Manifest& manifest_;
  const RunOptions& run_;
  LineOptions lines_;  // as the parts were made
  const AssembleOptions& options_;
  RunSummary summary_;
  std::vector<SurfaceSamples> samples_;
  std::optional<ErrorMeter> meter_;
};

}  // namespace

RunSummary assemble(const Stage& stage, const Manifest& manifest, const RunOptions& run,
                    std::span<const AcceptedJob> accepted, const AssembleOptions& options) {
  const SortPlan sorted(manifest, accepted);
  return Assembly(stage, sorted.manifest(), run, options).run(sorted.rest());
}

}  // namespace meshfarm
