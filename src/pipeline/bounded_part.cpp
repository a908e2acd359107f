// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_part.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bound_proof.hpp"

namespace meshfarm {
namespace {

/// The highest level that a mesh has reached for which this much was paid.
std::int32_t level_reached(double cost, double unit) {
  if (!(cost > 0)) return k_input_level;
  const std::int32_t level = level_of(cost, unit);
  return level_cost(level, unit) > cost ? level - 1 : level;
}

class PartSimplifier {
 public:
  PartSimplifier(const SimplifyParameters& parameters, const JobContext& context)
      : parameters_(parameters), context_(context) {}

  BoundedPart run(Part part) {
    samples_ = sample_surface(part.mesh, {.samples = parameters_.samples, .threads = 1});
    vertices_ = vertices_of(part);
    return write(parameters_.certified_error > 0 ? certified(part) : simplified(std::move(part)));
  }

 private:
  Simplifier simplified(Part part, double share = 1) const {
    const std::uint64_t before = part.mesh.triangles.size();
    std::optional<SurfaceBound> bound;
    if (before > 0) {
      bound.emplace(part.mesh, SurfaceBoundOptions{share * parameters_.max_error, 1});
    }
    Simplifier simplifier = cleaned(std::move(part), bound ? &*bound : nullptr);
    simplifier.reduce({}, [&](std::uint64_t left) { return goes_on(before, left); });
    return simplifier;
  }

  Simplifier cleaned(Part part, const SurfaceBound* bound) const {
    return {std::move(part.mesh),
            {.locked_vertices = part.boundary_vertices,
             .positions = part.positions,
             .lines = parameters_.lines,
             .bound = bound}};
  }

  bool goes_on(std::uint64_t before, std::uint64_t left) const {
    if (context_.progress(before - std::min(left, before))) return true;
    throw IncompleteError("the job was given up");
  }

  /// As simple as it may be with a proof; the part as it came has one.
  Simplifier certified(const Part& part) const {
    const BoundProof proof(part.mesh, parameters_.certified_error, 1);
    for (const double share : k_certified_shares) {
      Simplifier simplifier = simplified(part, share);
      if (proof.holds_for(simplifier.mesh())) return simplifier;
      goes_on(1, 1);
    }
    return cleaned(part, nullptr);
  }

  BoundedPart write(const Simplifier& simplifier) const {
    BoundedPart made;
    const Mesh& mesh = simplifier.mesh();
    ResultWriter result(vertices_, [&](std::string_view bytes) { made.file += bytes; });
    const double farthest =
        mesh.triangles.empty() ? 0 : DistanceMeter(mesh, 1).measure(samples_.points).max;
    result.add_rung(level_reached(simplifier.pass_cost(), parameters_.cost_unit), mesh,
                    simplifier.free_triangles(), farthest);
    result.finish(VertexView(mesh).part(0, vertices_.boundary), {&samples_, 1});
    made.summary = {result.rungs(), simplifier.dropped_degenerate(), simplifier.dropped_duplicate(),
                    false, simplifier.turned()};
    return made;
  }

  const SimplifyParameters& parameters_;
  const JobContext& context_;
  SurfaceSamples samples_;
  ResultWriter::Vertices vertices_;
};

}  // namespace

BoundedPart simplify_to_bound(Part part, const SimplifyParameters& parameters,
                              const JobContext& context) {
  return PartSimplifier(parameters, context).run(std::move(part));
}

}  // namespace meshfarm
