// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/adjacency.hpp"
#include "geometry/simplify_cost.hpp"
#include "geometry/simplify_lines.hpp"

namespace meshfarm {

/// The upper half of a ranking cost's bits: sorted like the costs, to one part in a million, over
/// the range of a double.
using CostKey = std::uint32_t;
constexpr CostKey k_any_cost = INT32_MAX;
CostKey key_of(double cost);
/// The greatest cost that has this key.
double cost_of(CostKey key);

/// Scrambles a number, so that a sample follows no pattern of the numbering.
constexpr std::uint32_t scrambled(std::uint32_t vertex) {
  return vertex * 2654435769U;
}

struct RankedEdge {
  std::uint32_t a;
  std::uint32_t b;
  CostKey key;
};

/// What ranking reads; all of it stays as it is for edges whose ends have not taken part in a
/// collapse yet.
struct RankingInput {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  std::span<const std::uint8_t> flags;  // VertexFlag
  const Adjacency* adjacency = nullptr;
  const CreaseTest* creases = nullptr;
  bool seam_only = false;
};

/// Which edges a pass may take: those that rank and cost no more than this.
struct RankLimits {
  CostKey key = k_any_cost;
  double max_cost = 0;
};

/// Ranks the edges of one mesh by what their collapse would cost. A vertex's quadric is the sum
/// over its star, an edge's the sum of its ends': the two triangles that they share count twice,
/// which leaves the order nearly as it is and saves looking them up.
class EdgeRanking {
 public:
  /// Sums the quadrics. Keeps its memory from one pass to the next.
  void begin_pass(const RankingInput& input);

  /// Estimates from a sample the key that the cheapest `share` (0 to 1) of all edges, but no more
  /// than `most`, do not exceed.
  CostKey estimate_limit(double share, double most);

  /// The edges within the limits whose smaller end is in [first, last), cheapest first; equal
  /// ones in order of their vertices. Valid until the next call.
  std::span<const RankedEdge> cheapest(std::uint32_t first, std::uint32_t last,
                                       const RankLimits& limits);

 private:
  struct Edge {
    std::uint32_t a;
    std::uint32_t b;
  };
  void sum_planes();
  void sum_line_planes();
  void list_edges_at(std::uint32_t vertex);
  template <typename Take>
  void cost_listed(const Take& take);
  template <typename Take>
  void for_creases_at(std::uint32_t vertex, const Take& take) const;
  EdgeCost cost_of_line_end(const Edge& e) const;
  std::uint64_t sample_costs(std::uint32_t one_in);
  void sort_found();

  RankingInput input_;
  std::vector<FloatQuadric> quadrics_;
  std::vector<Edge> listed_;  // the first listed_count_
  std::size_t listed_count_ = 0;
  EdgeCosts costs_;
  std::vector<RankedEdge> found_;  // the first found_count_
  std::size_t found_count_ = 0;
  std::vector<RankedEdge> sorted_;
  std::vector<std::uint32_t> starts_;
};

}  // namespace meshfarm
