// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

/// The angle between two vectors, in degrees; not finite if one of them is 0.
inline double degrees_between(Vec3 u, Vec3 v) {
  if (!(squared_length(u) > 0) || !(squared_length(v) > 0)) return NAN;
  return std::atan2(length(cross(u, v)), dot(u, v)) * (180 / std::acos(-1.0));
}

/// The triangle's normal, of any length.
inline Vec3 normal_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3 at = mesh.positions[a];
  return cross(mesh.positions[b] - at, mesh.positions[c] - at);
}

/// The angle between this normal, of a triangle that the point lies on, and the normal of the
/// nearest triangle of `mesh`, whose corners have these shares at the nearest point; negative if
/// one of them has no normal. Where several triangles are nearest, the one that is turned least
/// counts.
inline double degrees_turned(const Mesh& mesh, const Bvh& bvh, Vec3 point, Vec3 normal,
                             const Bvh::Nearest& nearest, const std::array<double, 3>& shares) {
  constexpr double k_inside = 1e-9;
  Vec3 there = normal_of(mesh, nearest.triangle);
  // Inside a triangle, only its other side can be equally near.
  const bool is_alone = std::min({shares[0], shares[1], shares[2]}) > k_inside;
  if (!is_alone || !(dot(normal, there) > 0)) {
    there = bvh.most_similar_normal(point, normal, nearest.squared);
  }
  const double degrees = degrees_between(normal, there);
  return std::isfinite(degrees) ? degrees : -1;
}

}  // namespace meshfarm
