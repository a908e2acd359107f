// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

/// A point of a surface that is far from another one, by the triangle that it lies on.
struct FarPoint {
  double distance = 0;
  std::uint32_t triangle = 0;
};

/// The greatest distance that is found from `from` to the other surface: that of all corners of
/// triangles, but of those with two at one place, and of those triangles that are farthest, by
/// corners or by `known` points, of points ever nearer to the farthest. No bound, but samples by
/// area alone miss more. Depends on no threads (0: one a core).
double find_farthest(const Mesh& from, const Bvh& to, std::span<const FarPoint> known,
                     unsigned threads);

}  // namespace meshfarm
