// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include <meshfarm/geometry/vec.hpp>
#include <meshfarm/geometry/weld.hpp>

namespace meshfarm {

/// The order of a sweep: by the coordinate along its axis, ascending or descending, then by the
/// others.
struct SweepOrder {
  std::array<int, 3> axes = {0, 1, 2};
  double sign = 1;  // -1: the first coordinate falls

  double along(Vec3 p) const { return sign * p[axes[0]]; }
  bool before(Vec3 a, Vec3 b) const {
    if (a[axes[0]] != b[axes[0]]) return along(a) < along(b);
    if (a[axes[1]] != b[axes[1]]) return a[axes[1]] < b[axes[1]];
    return a[axes[2]] < b[axes[2]];
  }
};

/// How slabs are sorted to streams.
struct Sorting {
  SweepOrder order;
  Weld weld = Weld::exact;
};

}  // namespace meshfarm
