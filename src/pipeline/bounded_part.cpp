// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_part.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/geometry/triangle_index.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/beyond_bound.hpp"
#include "pipeline/bound_proof.hpp"

namespace meshfarm {
namespace {

/// The highest level that a mesh has reached at this cost.
std::int32_t level_reached(double cost, double unit) {
  if (!(cost > 0)) return k_input_level;
  const std::int32_t level = level_of(cost, unit);
  return level_cost(level, unit) > cost ? level - 1 : level;
}

/// If less than this share of a part's triangles is lost, these are kept unchanged, and the rest is
/// simplified again as far as before; at most k_most_tries times per share of the bound.
constexpr double k_little_lost = 0.002;
constexpr std::size_t k_most_tries = 4;

/// Keeps these triangles and those that touch them.
void keep_round(const Mesh& mesh, const std::vector<Triangle>& lost,
                std::vector<std::uint8_t>& moves) {
  std::vector<std::uint8_t> flags(moves.size(), 0);
  for (const auto& [a, b, c] : lost) flags[a] = flags[b] = flags[c] = 1;
  for (const auto& [a, b, c] : mesh.triangles) {
    if ((flags[a] | flags[b] | flags[c]) != 0) moves[a] = moves[b] = moves[c] = 0;
  }
}

class PartSimplifier {
 public:
  PartSimplifier(const SimplifyParameters& parameters, const JobContext& context,
                 std::string_view beside)
      : parameters_(parameters), context_(context), beside_(beside) {}

  BoundedPart run(const Part& part) {
    samples_ = sample_surface(part.mesh, {.samples = parameters_.samples, .threads = 1});
    vertices_ = vertices_of(part);
    return write(parameters_.certified_error > 0 ? certified(part) : measured(part));
  }

 private:
  /// Where the result goes too far, the part stays unchanged there; if that would lock too many
  /// vertices, the part is simplified to a share of the bound instead.
  Simplifier measured(const Part& part) const {
    constexpr double k_little = 0.3;  // vertices, for each triangle of the result
    constexpr double k_less = 0.85;
    const double most = k_most_beyond_of_part * parameters_.max_error;
    std::optional<TriangleIndex> index;
    std::optional<AstrayFinder> finder;
    if (!part.mesh.triangles.empty()) finder.emplace(index.emplace(part.mesh, 1), most, 1);
    std::vector<std::uint8_t> moves = free_vertices(part);
    double share = 1;
    for (int tries = 1;; ++tries) {
      Simplifier simplifier = simplified(with_locked(part, moves), share);
      const Mesh& made = simplifier.mesh();
      if (made.triangles.empty() || tries == k_bounded_tries) return simplifier;
      goes_on(1, 1);
      const Mesh lost = part_beyond(part.mesh, TriangleIndex(made, 1), most, 1);
      goes_on(1, 1);
      const Mesh astray = finder->find(made);
      if (lost.triangles.empty() && astray.triangles.empty()) return simplifier;
      std::vector<std::uint8_t> left = moves;
      clear_near(lost, parameters_.max_error, part.mesh.positions, left);
      clear_near(astray, reach_of_astray(tries) * parameters_.max_error, part.mesh.positions, left);
      const auto held = static_cast<double>(std::count(left.begin(), left.end(), 0));
      const bool is_little =
          held - part.boundary_vertices < k_little * static_cast<double>(made.triangles.size());
      if (is_little && left != moves) {
        moves = std::move(left);
      } else {
        share *= k_less;
      }
    }
  }

  static std::vector<std::uint8_t> free_vertices(const Part& part) {
    std::vector<std::uint8_t> moves(part.mesh.positions.size(), 1);
    std::fill(moves.begin(), moves.begin() + part.boundary_vertices, std::uint8_t{0});
    return moves;
  }

  static Part with_locked(const Part& as_it_came, const std::vector<std::uint8_t>& moves) {
    Part part = as_it_came;
    part.boundary_vertices = put_last(part.mesh, moves);
    return part;
  }

  Simplifier simplified(Part part, double share) const {
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

  /// As simple as a proof allows; the unchanged part has one. Lost triangles are kept unchanged if
  /// they are few.
  Simplifier certified(const Part& part) const {
    const BoundProof proof(part.mesh, parameters_.certified_error, 1);
    std::vector<std::uint8_t> moves = free_vertices(part);
    std::size_t tries = 0;
    for (std::size_t i = 0; i < k_certified_shares.size();) {
      Simplifier simplifier = simplified(with_locked(part, moves), k_certified_shares[i]);
      goes_on(1, 1);
      const bool is_near = proof.is_near(simplifier.mesh());
      const std::vector<Triangle> lost = proof.find_lost(simplifier.mesh());
      if (is_near && lost.empty()) return simplifier;
      const bool is_little = static_cast<double>(lost.size()) <
                             k_little_lost * static_cast<double>(part.mesh.triangles.size());
      if (is_little) {
        keep_round(part.mesh, lost, moves);
      }
      if (!is_near || !is_little || ++tries >= k_most_tries) {
        ++i;
        tries = 0;
      }
    }
    return cleaned(part, nullptr);
  }

  BoundedPart write(const Simplifier& simplifier) const {
    BoundedPart made;
    const Mesh& mesh = simplifier.mesh();
    ResultWriter result(
        vertices_, [&](std::string_view bytes) { made.file += bytes; }, beside_);
    const double farthest =
        mesh.triangles.empty() ? 0 : DistanceMeter(mesh, 1).measure(samples_.points).max;
    result.add_rung(level_reached(simplifier.pass_cost(), parameters_.cost_unit), mesh,
                    simplifier.free_triangles(), farthest);
    result.finish(VertexView(mesh).part(0, vertices_.boundary), {&samples_, 1});
    made.summary = result.summary_of(simplifier);
    return made;
  }

  const SimplifyParameters& parameters_;
  const JobContext& context_;
  std::string_view beside_;
  SurfaceSamples samples_;
  ResultWriter::Vertices vertices_;
};

}  // namespace

BoundedPart simplify_to_bound(const Part& part, const SimplifyParameters& parameters,
                              const JobContext& context, std::string_view beside) {
  return PartSimplifier(parameters, context, beside).run(part);
}

}  // namespace meshfarm
