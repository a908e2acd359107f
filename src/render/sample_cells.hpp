// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/render/camera.hpp>

namespace meshfarm {

/// Identifies most triangles that cover no sample, for up to four pictures at once: most triangles
/// of a large mesh lie between two adjacent columns or rows of sample centres. One lane per camera,
/// in single precision; triangles in doubt may cover a sample.
class SampleCells {
 public:
  static constexpr std::size_t k_most_cameras = 4;

  /// Takes the vertices' positions. The cameras must outlive the object.
  SampleCells(std::span<const Camera* const> cameras, std::span<const Vec3> positions);

  /// One bit per camera: whether the triangle may cover a sample there.
  unsigned may_cover(const Triangle& t) const {
    const Lanes a = cells_[t[0]];
    const Lanes differs = (a ^ cells_[t[1]]) | (a ^ cells_[t[2]]);
    const auto same_column = ((differs >> 16) == 0) & ((a >> 16) != k_anywhere);
    const auto same_row = ((differs & k_anywhere) == 0) & ((a & k_anywhere) != k_anywhere);
    const auto is_one = same_column | same_row;  // all bits of a lane
    const auto bit = [&](int lane) { return is_one[lane] == 0 ? 1U << lane : 0U; };
    return bit(0) | bit(1) | bit(2) | bit(3);
  }

 private:
  using Lanes = std::uint32_t __attribute__((vector_size(16)));
  static constexpr std::uint32_t k_anywhere = 0xffff;  // near a middle, or off the picture

  std::unique_ptr<Lanes[]> cells_;  // per vertex: column (upper half) and row in each picture
};

}  // namespace meshfarm
