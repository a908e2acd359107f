// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A procedural closed surface of any size, made row by row: a torus with bumps of several
/// octaves and flat stretches, so that neighbouring regions deserve very different numbers of
/// triangles. Closed, oriented, one component, Euler characteristic 0.
class BumpyTorus {
 public:
  /// The number of triangles is the nearest that a grid of well-shaped triangles gives:
  /// 2 * rows * columns. Throws UsageError below 200 triangles and above 2^48.
  explicit BumpyTorus(std::uint64_t triangles);
  std::uint64_t vertices() const { return rows_ * columns_; }
  std::uint64_t triangles() const { return 2 * rows_ * columns_; }
  /// In order, in batches; coordinates are exact floats.
  void for_vertices(const std::function<void(std::span<const Vec3>)>& take) const;
  void for_triangles(
      const std::function<void(std::span<const std::array<std::uint64_t, 3>>)>& take) const;

 private:
  std::uint64_t rows_ = 0;
  std::uint64_t columns_ = 0;
};

/// Puts vertices and triangles into a random order that depends on `seed` alone, and turns the
/// triangles: the same surface, with no locality left.
void shuffle(Mesh& mesh, std::uint64_t seed);

}  // namespace meshfarm
