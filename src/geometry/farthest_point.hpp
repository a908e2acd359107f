// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

/// A point of a surface far from another surface, by the triangle that it lies on.
struct FarPoint {
  double distance = 0;
  std::uint32_t triangle = 0;
};

/// The greatest distance found from `from` to the other surface. Tries all triangle corners, except
/// of triangles with coincident corners, and, in the triangles that are farthest by their corners
/// or by `known` points, points that close in on the farthest. This is not a bound, but samples by
/// area alone miss more. The result does not depend on the threads (0: one per core).
double find_farthest(const Mesh& from, const Bvh& to, std::span<const FarPoint> known,
                     unsigned threads);

}  // namespace meshfarm
