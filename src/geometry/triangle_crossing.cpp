// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/triangle_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/exact_signs.hpp"

namespace meshfarm {
namespace {

constexpr std::array<Axes, 3> k_planes = {Axes{0, 1}, Axes{1, 2}, Axes{2, 0}};

int turn_of(const TriangleCorners& t, Axes axes) {
  return turn(t[0], t[1], t[2], axes);
}

/// Axes in whose plane the triangle has an area.
Axes axes_of(const TriangleCorners& t) {
  return *std::find_if(k_planes.begin(), k_planes.end() - 1,
                       [&](Axes axes) { return turn_of(t, axes) != 0; });
}

std::array<int, 3> sides(const TriangleCorners& of, const TriangleCorners& plane) {
  std::array<int, 3> sides{};
  std::transform(of.begin(), of.end(), sides.begin(),
                 [&](Vec3 p) { return side_of_plane(plane[0], plane[1], plane[2], p); });
  return sides;
}

bool are_beyond(const std::array<int, 3>& sides) {
  return sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2];
}
bool are_in_plane(const std::array<int, 3>& sides) {
  return sides[0] == 0 && sides[1] == 0 && sides[2] == 0;
}

/// Whether the line through p and q, not both in the triangle's plane, goes through it.
bool goes_through(Vec3 p, Vec3 q, const TriangleCorners& t) {
  const int first = side_of_plane(p, q, t[0], t[1]);
  const int second = side_of_plane(p, q, t[1], t[2]);
  if (first * second < 0) return false;
  const int third = side_of_plane(p, q, t[2], t[0]);
  return first * third >= 0 && second * third >= 0;
}

/// Whether a side of `a` goes through `b`; `sides` are those of a's corners.
bool has_side_through(const TriangleCorners& a, const std::array<int, 3>& sides,
                      const TriangleCorners& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    // The ends of a side in the plane are covered by the other sides.
    if (sides[k] * sides[next] > 0 || (sides[k] == 0 && sides[next] == 0)) continue;
    if (goes_through(a[k], a[next], b)) return true;
  }
  return false;
}

/// Whether all of `b` is beyond one side of `a`, in their plane.
bool is_beyond_a_side(const TriangleCorners& a, const TriangleCorners& b, Axes axes) {
  const int inside = turn_of(a, axes);
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::all_of(b.begin(), b.end(),
                    [&](Vec3 p) { return turn(a[k], a[(k + 1) % 3], p, axes) == -inside; })) {
      return true;
    }
  }
  return false;
}

bool cross_apart(const TriangleCorners& a, const TriangleCorners& b) {
  const std::array<int, 3> of_b = sides(b, a);
  if (are_beyond(of_b)) return false;
  if (are_in_plane(of_b)) {
    const Axes axes = axes_of(a);
    return !is_beyond_a_side(a, b, axes) && !is_beyond_a_side(b, a, axes);
  }
  const std::array<int, 3> of_a = sides(a, b);
  if (are_beyond(of_a)) return false;
  return has_side_through(a, of_a, b) || has_side_through(b, of_b, a);
}

/// Whether the ray from t's first corner to p leads into t, in their plane.
bool leads_into(Vec3 p, const TriangleCorners& t, Axes axes) {
  const int inside = turn_of(t, axes);
  return turn(t[0], t[1], p, axes) != -inside && turn(t[0], p, t[2], axes) != -inside;
}

/// The first corners are the same. If the triangles meet at more than that, the intersection
/// reaches the far side of one of them.
bool cross_at_corner(const TriangleCorners& a, const TriangleCorners& b) {
  const int b_1 = side_of_plane(a[0], a[1], a[2], b[1]);
  const int b_2 = side_of_plane(a[0], a[1], a[2], b[2]);
  if (b_1 * b_2 > 0) return false;
  if (b_1 == 0 && b_2 == 0) {
    const Axes axes = axes_of(a);
    return leads_into(a[1], b, axes) || leads_into(a[2], b, axes) || leads_into(b[1], a, axes) ||
           leads_into(b[2], a, axes);
  }
  const int a_1 = side_of_plane(b[0], b[1], b[2], a[1]);
  const int a_2 = side_of_plane(b[0], b[1], b[2], a[2]);
  if (a_1 * a_2 > 0) return false;
  return goes_through(a[1], a[2], b) || goes_through(b[1], b[2], a);
}

/// The first two corners are the same: whether the triangles are folded flat onto each other.
bool cross_at_side(const TriangleCorners& a, const TriangleCorners& b) {
  if (side_of_plane(a[0], a[1], a[2], b[2]) != 0) return false;
  const Axes axes = axes_of(a);
  return turn_of(a, axes) == turn(a[0], a[1], b[2], axes);
}

bool has_area(const TriangleCorners& triangle) {
  return std::any_of(k_planes.begin(), k_planes.end(),
                     [&](Axes axes) { return turn_of(triangle, axes) != 0; });
}

void put_common_first(TriangleCorners& a, TriangleCorners& b) {
  std::size_t common = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto next = b.begin() + static_cast<std::ptrdiff_t>(common);
    const auto same = std::find(next, b.end(), a[i]);
    if (same == b.end()) continue;
    std::iter_swap(same, next);
    std::swap(a[i], a[common]);
    ++common;
  }
}

double largest(Vec3 v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::size_t common_corners(const TriangleCorners& a, const TriangleCorners& b) {
  std::size_t common = 0;
  for (const Vec3& p : a) common += (p == b[0] || p == b[1] || p == b[2]) ? 1 : 0;
  return common;
}

/// Whether all corners of `b` that are not a's are certainly on one side of a's plane. A common
/// corner is never certainly on a side.
bool lies_beside(const CrossingTriangle& a, const CrossingTriangle& b, std::size_t common) {
  std::size_t above = 0, below = 0;
  for (const Vec3& p : b.corners) {
    const Vec3 from = p - a.corners[0];
    const double height = dot(a.normal, from);
    const double rounding = a.rounding * largest(from) + 1e-280;  // plus what underflows
    above += height > rounding ? 1 : 0;
    below += height < -rounding ? 1 : 0;
  }
  return above == 3 - common || below == 3 - common;
}

}  // namespace

CrossingTriangle::CrossingTriangle(const TriangleCorners& from) : corners(from) {
  for (const Vec3& p : corners) box.add(p);
  const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
  normal = cross(u, v);
  rounding = 64 * 0x1p-53 * largest(u) * largest(v);
  has_area = largest(normal) > rounding + 1e-280 || meshfarm::has_area(corners);
}

bool do_cross(const CrossingTriangle& a, const CrossingTriangle& b) {
  if (!a.has_area || !b.has_area) return false;
  const std::size_t common = common_corners(a.corners, b.corners);
  if (common == 3) return true;
  if (lies_beside(a, b, common) || lies_beside(b, a, common)) return false;
  TriangleCorners first = a.corners;
  TriangleCorners second = b.corners;
  put_common_first(first, second);
  switch (common) {
    case 0:
      return cross_apart(first, second);
    case 1:
      return cross_at_corner(first, second);
    default:
      return cross_at_side(first, second);
  }
}

}  // namespace meshfarm
