// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/working_mesh.hpp"

namespace meshfarm {

/// With whom a vertex merges in a rough pass.
class RoughPartners {
 public:
  /// `touched`: who took part in a collapse of the pass already.
  RoughPartners(const CollapseState& state, std::span<const std::uint8_t> touched)
      : state_(state), touched_(touched) {}

  /// The nearest neighbour that the vertex may merge with; the vertex itself if there is none.
  std::uint32_t of(std::uint32_t vertex) const;

  /// The cost that the cheapest `share` (0 to 1) of the vertices would pay to merge with their
  /// partners, but no more than `most`, estimated from a sample; nothing if too few could for it,
  /// or if edges that are not the shortest cost far less: along tubes and steep folds.
  std::optional<double> estimate_limit(CollapseJudge& judge, double share, double most) const;

 private:
  /// What the cheapest collapse of an edge at the vertex costs.
  double cheapest_at(std::uint32_t vertex, CollapseJudge& judge) const;

  CollapseState state_;
  std::span<const std::uint8_t> touched_;
};

/// A pass that ranks no edges: it walks through the vertices in their order and merges each with
/// its nearest neighbour, if that costs little enough. For meshes far above their goal: such passes
/// halve the time and cost 1 % of the error on the dragon and none on terrain.
class RoughPass {
 public:
  /// Whether a mesh is so far above the goal.
  static bool is_worth_it(const WorkingMesh& mesh, const SimplifyGoal& goal);

  explicit RoughPass(WorkingMesh& mesh) : mesh_(mesh) {}

  /// Merges what may merge, compacts the mesh, and returns the number of triangles removed.
  std::uint64_t run(const SimplifyGoal& goal);

 private:
  WorkingMesh& mesh_;
};

}  // namespace meshfarm
