// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

// Signs of determinants, exact if no difference of coordinates is above 1e100, or above 0 and below
// 1e-90 times the greatest. Computed as usual where rounding cannot change the sign, otherwise
// exactly (Shewchuk 1997).

/// A coordinate plane: the axes that are kept of a point in space.
struct Axes {
  int first = 0;
  int second = 1;
};

int exact_side_of_plane(Vec3 a, Vec3 b, Vec3 c, Vec3 p);
int exact_turn(Vec3 a, Vec3 b, Vec3 c, Axes axes);

/// The side of the plane through a, b and c on which p lies: 1 on the side from which they appear
/// counter-clockwise, -1 on the other, 0 on the plane or if the three are collinear.
inline int side_of_plane(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double yz = v.y * w.z, zy = v.z * w.y;
  const double zx = v.z * w.x, xz = v.x * w.z;
  const double xy = v.x * w.y, yx = v.y * w.x;
  const double volume = u.x * (yz - zy) + u.y * (zx - xz) + u.z * (xy - yx);
  const double all = std::abs(u.x) * (std::abs(yz) + std::abs(zy)) +
                     std::abs(u.y) * (std::abs(zx) + std::abs(xz)) +
                     std::abs(u.z) * (std::abs(xy) + std::abs(yx));
  constexpr double k_rounding = 8 * 0x1p-53;
  constexpr double k_tiny = 1e-280;  // more than is lost where products underflow
  if (all > k_tiny && std::abs(volume) > k_rounding * all) return volume > 0 ? 1 : -1;
  return exact_side_of_plane(a, b, c, p);
}

/// 1 if a, b and c go counter-clockwise in the plane of these axes, -1 if clockwise, 0 if they are
/// collinear there.
inline int turn(Vec3 a, Vec3 b, Vec3 c, Axes axes) {
  const double left = (b[axes.first] - a[axes.first]) * (c[axes.second] - a[axes.second]);
  const double right = (b[axes.second] - a[axes.second]) * (c[axes.first] - a[axes.first]);
  const double all = std::abs(left) + std::abs(right);
  constexpr double k_rounding = 4 * 0x1p-53;
  constexpr double k_tiny = 1e-280;
  if (all > k_tiny && std::abs(left - right) > k_rounding * all) return left > right ? 1 : -1;
  return exact_turn(a, b, c, axes);
}

}  // namespace meshfarm
