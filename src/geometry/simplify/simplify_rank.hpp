// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/appearance_star.hpp"
#include "geometry/simplify/simplify_cost.hpp"
#include "geometry/simplify/simplify_lines.hpp"
#include "geometry/simplify/wedge_star.hpp"

namespace meshfarm {

/// The upper half of a ranking cost's bits: sorted like the costs, to one part in a million, over
/// the range of a double.
using CostKey = std::uint32_t;
constexpr CostKey k_any_cost = INT32_MAX;
CostKey key_of(double cost);
/// The greatest cost that has this key.
double cost_of(CostKey key);

/// A pass takes edges up to this power of two times the cost of the cheaper half of them. Where
/// straight edges and flat faces cost nothing, a share of all edges would otherwise reach expensive
/// ones before all free ones have had their turn.
constexpr int k_greatest_jump = 10;

/// Scrambles a number, so that a sample follows no pattern of the numbering.
constexpr std::uint32_t scrambled(std::uint32_t vertex) {
  return vertex * 2654435769U;
}

struct RankedEdge {
  std::uint32_t a;
  std::uint32_t b;
  CostKey key;
};

/// The input of a ranking. It stays unchanged for edges whose ends have not taken part in a
/// collapse yet.
struct RankingInput {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  std::span<const std::uint8_t> flags;  // VertexFlag
  const Adjacency* adjacency = nullptr;
  const CreaseTest* creases = nullptr;
  bool seam_only = false;
  /// Edges at complex vertices are listed, too: a GeneralJudge is there to judge them.
  bool general = false;
  bool any_topology = false;                // and edges that would change the topology
  bool bounds = false;                      // rank by lower bounds of the costs
  std::span<const Appearance> appearances;  // empty if they are not used
  AppearanceScale appearance_scale;
  double uv_scale = 0;
};

/// Which edges a pass may take: those that rank and cost no more than this.
struct RankLimits {
  CostKey key = k_any_cost;
  double max_cost = 0;
};

/// Ranks the edges of one mesh by the cost of their collapse. A vertex's quadric is the sum over
/// its star, an edge's the sum of its two ends'. The two triangles that the ends share count twice,
/// which hardly changes the order and saves looking them up.
class EdgeRanking {
 public:
  /// Sums the quadrics. Keeps its memory from one pass to the next.
  void begin_pass(const RankingInput& input);
  /// From then on, costs that float is too coarse for are ranked in double precision, for 48 bytes
  /// more per vertex. For surfaces that are flat apart from noise or rounding.
  void refine();
  bool is_refined() const { return !fine_.empty(); }

  /// Estimates from a sample the greatest key of the cheapest `share` (0 to 1) of all edges, but of
  /// no more than `most` edges.
  CostKey estimate_limit(double share, double most);

  /// The edges within the limits whose smaller end is in [first, last), cheapest first; equal
  /// ones in order of their vertices. Valid until the next call.
  std::span<const RankedEdge> cheapest(std::uint32_t first, std::uint32_t last,
                                       const RankLimits& limits);

  // For a mesh that changes while its edges are ranked.

  /// The mesh has more vertices than before, or they have moved in memory.
  void move_to(std::span<const Vec3> positions, std::span<const std::uint8_t> flags,
               std::span<const Appearance> appearances);
  /// Recomputes the quadric of a vertex whose star has changed.
  void refresh(std::uint32_t vertex);
  /// Calls take(edge) for all edges at the vertex that may collapse and may cost at most
  /// `max_cost`, in the order of its corners.
  template <typename Take>
  void for_edges_at(std::uint32_t vertex, double max_cost, const Take& take) {
    list_edges_at(vertex, 0);
    cost_listed([&](const Edge& e, const EdgeCost& cost) {
      if (cost.least > max_cost) return;
      take(RankedEdge{std::min(e.a, e.b), std::max(e.a, e.b), key_of(cost.ranking)});
    });
  }

 private:
  struct Edge {
    std::uint32_t a;
    std::uint32_t b;
  };
  void sum_planes();
  void sum_line_planes();
  Quadric appearance_at(std::uint32_t vertex);
  bool weighs_uvs() const { return input_.uv_scale > 0 && input_.adjacency->has_uvs(); }
  Quadric uvs_at(std::uint32_t vertex);
  Quadric line_planes_at(std::uint32_t vertex) const;
  /// Lists the edges whose other end is `least` or greater.
  void list_edges_at(std::uint32_t vertex, std::uint32_t least);
  template <typename Take>
  void cost_listed(const Take& take);
  template <typename Take>
  void for_creases_at(std::uint32_t vertex, const Take& take) const;
  template <typename Moved>
  EdgeCost cost_of_line_end(const Edge& e, const Moved& moved) const;
  EdgeCost cost_of_line_end(const Edge& e) const;
  EdgeCost fine_cost_of(const Edge& e, bool is_by_end) const;
  bool is_all_of_piece(const Edge& e) const;
  std::uint64_t sample_costs(std::uint32_t one_in);
  void sort_found();

  RankingInput input_;
  std::vector<FloatQuadric> quadrics_;
  std::vector<Quadric> fine_;  // the same, if refined
  std::vector<Edge> listed_;   // the first listed_count_
  std::size_t listed_count_ = 0;
  EdgeCosts costs_;
  AppearanceStar star_;
  std::vector<std::pair<Uv, LinearUvSums>> wedges_;  // of one vertex
  std::vector<RankedEdge> found_;                    // the first found_count_
  std::size_t found_count_ = 0;
  std::vector<RankedEdge> sorted_;
  std::vector<std::uint32_t> starts_;
};

/// Calls take(edge, cost) for the listed edges.
template <typename Take>
void EdgeRanking::cost_listed(const Take& take) {
  const Vec3* const positions = input_.positions.data();
  const std::uint8_t* const flags = input_.flags.data();
  // With texture coordinates, vertices on lines merge to one of the two ends.
  const int by_ends = input_.adjacency->has_uvs() ? k_line | k_corner : 0;
  const bool ends_pieces = input_.bounds && input_.any_topology;
  for (std::size_t first = 0; first < listed_count_; first += EdgeCosts::k_size) {
    const std::size_t count = std::min(EdgeCosts::k_size, listed_count_ - first);
    const Edge* const edges = listed_.data() + first;
    for (std::size_t i = 0; i < count; ++i) {
      const auto [a, b] = edges[i];
      costs_.put(i, quadrics_[a], quadrics_[b], (positions[b] - positions[a]) * 0.5);
    }
    costs_.compute(input_.bounds);
    for (std::size_t i = 0; i < count; ++i) {
      const Edge& e = edges[i];
      if (ends_pieces && is_all_of_piece(e)) {
        take(e, EdgeCost{});
        continue;
      }
      const int unlike = (flags[e.a] ^ flags[e.b]) & (k_line | k_corner | k_fixed);
      const bool is_by_end = (unlike | (flags[e.a] & by_ends)) != 0;
      const EdgeCost cost = is_by_end ? cost_of_line_end(e) : costs_.get(i);
      take(e, cost.is_rough && is_refined() ? fine_cost_of(e, is_by_end) : cost);
    }
  }
  listed_count_ = 0;
}

}  // namespace meshfarm
