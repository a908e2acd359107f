// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

using TriangleCorners = std::array<Vec3, 3>;

/// Branch-free, because half of the branches would be mispredicted.
inline bool do_touch(const Box& a, const Box& b) {
  const double x = std::max(a.lo.x - b.hi.x, b.lo.x - a.hi.x);
  const double y = std::max(a.lo.y - b.hi.y, b.lo.y - a.hi.y);
  const double z = std::max(a.lo.z - b.hi.z, b.lo.z - a.hi.z);
  return std::max({x, y, z}) <= 0;
}

/// A triangle, with data that quickly rules out crossings.
struct CrossingTriangle {
  TriangleCorners corners{};
  Box box{};
  Vec3 normal{};        // rounded, not of length 1
  double rounding = 0;  // farther along the normal is certainly off the plane
  bool has_area = false;

  CrossingTriangle() = default;
  explicit CrossingTriangle(const TriangleCorners& from);
};

/// Whether two triangles meet at more than shared corners or sides: one cuts the other, touches it
/// where that has no corner, or lies on it. Corners at one place are one. Triangles without area
/// cross nothing. Exact.
bool do_cross(const CrossingTriangle& a, const CrossingTriangle& b);

}  // namespace meshfarm
