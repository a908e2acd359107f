// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

/// Walks over a surface towards a point, from a triangle to the one across the side that is nearest
/// to the point. On a smooth surface that soon comes to the nearest triangle, in a fraction of the
/// time that a search from the root of a hierarchy takes. 12 bytes a triangle, 24 more while it is
/// made. The mesh must outlive it.
class SurfaceWalk {
 public:
  explicit SurfaceWalk(const Mesh& mesh);

  /// The nearest triangle that a few steps from `start` come to. Stops at one whose squared
  /// distance is at most `enough`.
  Bvh::Nearest towards(Vec3 point, std::uint32_t start, double enough) const;

 private:
  const Mesh& mesh_;
  /// Across the sides from each corner to the next: itself at a border.
  std::vector<std::array<std::uint32_t, 3>> across_;
};

}  // namespace meshfarm
