// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_part.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// The highest level that a mesh has reached for which this much was paid.
std::int32_t level_reached(double cost, double unit) {
  if (!(cost > 0)) return k_input_level;
  const std::int32_t level = level_of(cost, unit);
  return level_cost(level, unit) > cost ? level - 1 : level;
}

}  // namespace

BoundedPart simplify_to_bound(Part part, const SimplifyParameters& parameters,
                              const JobContext& context) {
  const SurfaceSamples samples =
      sample_surface(part.mesh, {.samples = parameters.samples, .threads = 1});
  const std::uint64_t before = part.mesh.triangles.size();
  const ResultWriter::Vertices vertices = vertices_of(part);
  std::optional<SurfaceBound> bound;
  if (before > 0) bound.emplace(part.mesh, SurfaceBoundOptions{parameters.max_error, 1});
  Simplifier simplifier(std::move(part.mesh), {.locked_vertices = part.boundary_vertices,
                                               .positions = part.positions,
                                               .lines = parameters.lines,
                                               .bound = bound ? &*bound : nullptr});
  simplifier.reduce({}, [&](std::uint64_t left) {
    if (context.progress(before - std::min(left, before))) return true;
    throw IncompleteError("the job was given up");
  });

  BoundedPart made;
  const Mesh& mesh = simplifier.mesh();
  ResultWriter result(vertices, [&](std::string_view bytes) { made.file += bytes; });
  const double farthest =
      mesh.triangles.empty() ? 0 : DistanceMeter(mesh, 1).measure(samples.points).max;
  result.add_rung(level_reached(simplifier.pass_cost(), parameters.cost_unit), mesh,
                  simplifier.free_triangles(), farthest);
  result.finish(VertexView(mesh).part(0, vertices.boundary), {&samples, 1});
  made.summary = {result.rungs(), simplifier.dropped_degenerate(), simplifier.dropped_duplicate(),
                  false, simplifier.turned()};
  return made;
}

}  // namespace meshfarm
