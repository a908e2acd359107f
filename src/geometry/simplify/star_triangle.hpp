// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// A triangle at a vertex, or at one end of an edge, relative to a point near by.
struct StarTriangle {
  Vec3 end;  // the corner at the vertex in question
  Vec3 p;
  Vec3 q;
  Vec3 normal;  // twice the area long
  double squared_size = 0;

  static StarTriangle of(Vec3 end, Vec3 p, Vec3 q) {
    const Vec3 normal = cross(p - end, q - end);
    return {end, p, q, normal, squared_length(normal)};
  }
};

}  // namespace meshfarm
