// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/appearance_star.hpp"
#include "geometry/simplify/quadric.hpp"
#include "geometry/simplify/simplify_lines.hpp"

namespace meshfarm {

/// The state that the collapses of one pass work on.
struct CollapseState {
  std::span<Vec3> positions;
  std::span<const std::uint8_t> flags;    // VertexFlag
  std::span<const std::uint32_t> target;  // the vertex that a vertex has become in this pass
  const Adjacency* adjacency = nullptr;   // as it was when the pass began
  PositionType type = PositionType::float64;
  const CreaseTest* creases = nullptr;  // where vertices are flagged as on creases
  std::span<Appearance> appearances;    // empty if they are not used
  AppearanceScale appearance_scale;
  double uv_scale = 0;                    // LineOptions::uv_scale
  std::span<const PastPlanes> past = {};  // of complex vertices and ribbons' ends, or empty
  bool turns_ribbons = true;              // Turn::ribbon is allowed

  /// The appearances of a triangle's corners, beginning with the one at the vertex.
  AppearanceStar::Values values_at(std::uint32_t vertex, const Corner& c) const {
    return {appearances[vertex], appearances[c.next], appearances[c.prev]};
  }
  /// For the edge from middle - half to middle + half, with no planes yet.
  EdgeQuadric quadric_of(Vec3 middle, Vec3 half) const {
    const auto greatest = [](Vec3 p) {
      return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    };
    const double step =
        (type == PositionType::float32 ? 0x1p-23 : 0x1p-52) * (greatest(middle) + greatest(half));
    EdgeQuadric quadric;
    quadric.squared_length = 4 * squared_length(half);
    quadric.squared_rounding = step * step;
    return quadric;
  }
  bool has_uvs() const { return adjacency->has_uvs(); }
};

}  // namespace meshfarm
