// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// The squared distance from a point to the segment from a to b, which may be a point.
inline double squared_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a, ap = p - a;
  const double along = dot(ap, ab), all = dot(ab, ab);
  if (!(along > 0)) return dot(ap, ap);
  if (along >= all) return squared_length(p - b);
  return squared_length(ap - ab * (along / all));
}

/// The distance of a point from a triangle, and the nearest side if the point is beyond one.
/// Degenerate triangles count as the segments or points that they are.
struct DistanceAcross {
  static constexpr std::size_t k_inside = 3;
  double squared = HUGE_VAL;
  std::size_t side = k_inside;  // 0: from the first corner to the second

  bool is_inside() const { return side == k_inside; }

  void offer_side(std::size_t number, Vec3 p, Vec3 from, Vec3 to) {
    const double here = squared_to_segment(p, from, to);
    if (!(here < squared)) return;
    squared = here;
    side = number;
  }
};

/// `known` is an already known squared distance. If the triangle's plane is certainly farther away,
/// `squared` is infinite, and the side means nothing.
inline DistanceAcross distance_across(Vec3 p, Vec3 a, Vec3 b, Vec3 c, double known = HUGE_VAL) {
  // Allow for the rounding of the height, which is large for narrow triangles.
  constexpr double k_above = 1 + 1e-6;
  constexpr double k_rounding = 1e-22;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = cross(ab, ac);
  const double area = dot(normal, normal);
  const double height = dot(ap, normal);
  if (known < HUGE_VAL) {
    const double rounding = k_rounding * dot(ab, ab) * dot(ac, ac) * dot(ap, ap);
    if (height * height > k_above * known * area + rounding) return {};
  }
  const double at_b = dot(cross(ap, ac), normal);
  const double at_c = dot(cross(ab, ap), normal);
  const double at_a = area - at_b - at_c;
  if (area > 0 && at_a >= 0 && at_b >= 0 && at_c >= 0) {
    return {height * height / area, DistanceAcross::k_inside};
  }
  DistanceAcross found;
  if (!(area > 0) || at_c < 0) found.offer_side(0, p, a, b);
  if (!(area > 0) || at_a < 0) found.offer_side(1, p, b, c);
  if (!(area > 0) || at_b < 0) found.offer_side(2, p, a, c);
  return found;
}

}  // namespace meshfarm
