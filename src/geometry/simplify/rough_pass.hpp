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

/// Finds the vertex that a vertex merges with in a rough pass.
class RoughPartners {
 public:
  /// `touched`: which vertices have already taken part in a collapse of the pass.
  RoughPartners(const CollapseState& state, std::span<const std::uint8_t> touched)
      : state_(state), touched_(touched) {}

  /// The nearest neighbour that the vertex may merge with; the vertex itself if there is none.
  std::uint32_t of(std::uint32_t vertex) const;

  /// The greatest cost that the cheapest `share` (0 to 1) of the vertices would pay to merge with
  /// their partners, but at most `most`, estimated from a sample. Nothing if too few could merge
  /// for it, or if edges other than the shortest cost far less, as along tubes and steep folds.
  std::optional<double> estimate_limit(CollapseJudge& judge, double share, double most) const;

 private:
  /// The cost of the cheapest collapse of an edge at the vertex.
  double cheapest_at(std::uint32_t vertex, CollapseJudge& judge) const;

  CollapseState state_;
  std::span<const std::uint8_t> touched_;
};

/// A pass that ranks no edges: it walks through the vertices in order and merges each with its
/// nearest neighbour, if that is cheap enough. For meshes far above their goal: such passes halve
/// the time, and cost 1 % of the error on the dragon and none on terrain.
class RoughPass {
 public:
  /// Whether a mesh is far enough above the goal.
  static bool is_worth_it(const WorkingMesh& mesh, const SimplifyGoal& goal);

  explicit RoughPass(WorkingMesh& mesh) : mesh_(mesh) {}

  /// Merges what may merge, compacts the mesh, and returns the number of triangles removed.
  std::uint64_t run(const SimplifyGoal& goal);

 private:
  WorkingMesh& mesh_;
};

}  // namespace meshfarm
