// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

struct CrossingOptions {
  unsigned threads = 0;  // 0: one a core. Nothing depends on it.
  /// So many pairs of triangles whose boxes touch are not too many for a mesh of any size, nor is
  /// the second number for each of its triangles. Surfaces have about ten a triangle.
  std::uint64_t pairs = 50'000'000;
  std::uint64_t pairs_a_triangle = 200;
};

/// The triangles that cut another one, touch it where it has no corner of theirs, or lie on it:
/// those that share a corner meet at more than that, and those that share a side are folded flat
/// onto each other. Vertices at one place are one; triangles of no area do not count. The count is
/// exact, whatever rounding does. Nothing if so many triangles lie at one place that it would take
/// too long.
/// Memory: about 15 bytes a triangle, and 20 for the index. Coordinates must be finite.
std::optional<std::uint64_t> count_crossing_triangles(const TriangleIndex& index,
                                                      const CrossingOptions& options);
std::optional<std::uint64_t> count_crossing_triangles(const Mesh& mesh,
                                                      const CrossingOptions& options);

}  // namespace meshfarm
