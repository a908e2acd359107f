// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// The grid cells near a surface: tells quickly which parts of another surface may matter. 2 MB.
class NearCells {
 public:
  /// The cells of these triangles' boxes, grown by the distance.
  NearCells(std::span<const Vec3> positions, std::span<const Triangle> triangles, double distance);
  /// Whether the box shares a cell with what is near. If so, it may still be a little farther away.
  bool touch(const Box& box) const;
  /// The indices of the triangles whose boxes do.
  std::vector<std::uint32_t> touching(std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles) const;

 private:
  using Cell = std::array<int, 3>;
  static constexpr int k_cells = 256;  // on a side

  bool touch_box_of(std::span<const Vec3> positions, const Triangle& triangle) const;
  Cell cell_of(Vec3 p) const;
  static std::size_t index_of(int x, int y, int z) {
    return (static_cast<std::size_t>(z) * k_cells + static_cast<std::size_t>(y)) * k_cells +
           static_cast<std::size_t>(x);
  }
  template <typename Take>
  static bool any_cell(Cell lo, Cell hi, const Take& take);

  Box box_;
  double per_unit_ = 1;  // cells
  std::vector<bool> near_;
};

}  // namespace meshfarm
