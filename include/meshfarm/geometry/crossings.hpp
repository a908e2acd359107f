// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

struct CrossingOptions {
  unsigned threads = 0;  // 0: one per core. Nothing depends on it.
  /// Limit of pairs of triangles whose boxes touch: the greater of `pairs` and `pairs_a_triangle`
  /// times the triangles. Surfaces have about ten pairs per triangle.
  std::uint64_t pairs = 50'000'000;
  std::uint64_t pairs_a_triangle = 200;
};

/// Counts the triangles that cut another one, touch it where it has no common corner, or lie on it.
/// Triangles that share a corner count if they meet elsewhere, too; those that share a side, if
/// they are folded flat onto each other. Coincident vertices are one; triangles without area do not
/// count. The count is exact, regardless of rounding. Returns nothing if too many triangles lie at
/// one place, so that it would take too long. Memory: about 15 bytes per triangle, and 20 for the
/// index. Coordinates must be finite.
std::optional<std::uint64_t> count_crossing_triangles(const TriangleIndex& index,
                                                      const CrossingOptions& options);
std::optional<std::uint64_t> count_crossing_triangles(const Mesh& mesh,
                                                      const CrossingOptions& options);

}  // namespace meshfarm
