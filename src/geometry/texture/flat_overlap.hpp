// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/texture/flat.hpp"

namespace meshfarm {

/// Finds overlapping triangles in a plane, using a grid of cells. Triangles must be
/// counter-clockwise; those without an area overlap nothing. Touching is not overlapping.
class FlatOverlaps {
 public:
  explicit FlatOverlaps(std::span<const FlatTriangle> triangles);

  /// Whether no two triangles overlap.
  bool none() const;
  /// Whether the triangle overlaps another one for which counts(index) is true.
  template <typename Counts>
  bool any_with(std::uint32_t triangle, const Counts& counts) const {
    if (!is_solid_[triangle]) return false;
    const Range cells = cells_of(triangle);
    for (std::uint32_t y = cells.y0; y <= cells.y1; ++y) {
      for (std::uint32_t x = cells.x0; x <= cells.x1; ++x) {
        for (const std::uint32_t other : in_cell(y * columns_ + x)) {
          if (other != triangle && counts(other) && overlap(triangle, other)) return true;
        }
      }
    }
    return false;
  }

 private:
  struct Range {
    std::uint32_t x0, y0, x1, y1;
  };
  Range cells_of(std::uint32_t triangle) const;
  std::uint32_t cell_at(double along, std::uint32_t cells) const;
  std::span<const std::uint32_t> in_cell(std::size_t cell) const {
    return {items_.data() + first_[cell], first_[cell + 1] - first_[cell]};
  }
  bool overlap(std::uint32_t a, std::uint32_t b) const;
  bool is_clear(const FlatTriangle& a, const FlatTriangle& b) const;
  bool cell_is_clear(std::uint32_t triangle, std::uint32_t x, std::uint32_t y) const;
  template <typename Take>
  void for_cells(const Take& take) const;

  std::span<const FlatTriangle> triangles_;
  FlatBox box_;
  double per_cell_ = 0;  // 1 / a cell's side
  double slack_ = 0;     // tolerance
  std::uint32_t columns_ = 1;
  std::uint32_t rows_ = 1;
  std::vector<std::uint8_t> is_solid_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> items_;
};

}  // namespace meshfarm
