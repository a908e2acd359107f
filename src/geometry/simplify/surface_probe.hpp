// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/surface_bound.hpp>

namespace meshfarm {

/// Tells whether new triangles are within a bound of a surface, by points of them.
///
/// Between two surfaces that are nearly parallel the distance is greatest at a vertex of either, or
/// where two of their sides cross. So of a triangle the corners and the sides are looked at
/// closely, and what is inside only where no point of the surface is near.
class SurfaceProbe {
 public:
  /// `bound` must outlive it.
  explicit SurfaceProbe(const SurfaceBound& bound) : bound_(bound) {}

  bool is_near(Vec3 point);
  /// Of a side; not its ends.
  bool is_side_near(Vec3 from, Vec3 to);
  /// Of a triangle whose sides and corners are near. `feet`: points of the surface that are within
  /// the bound of this triangle, and have others near them.
  bool is_inside_near(const std::array<Vec3, 3>& triangle, std::span<const Vec3> feet);

 private:
  /// Divides the first two sides of a triangle.
  struct Grid {
    Vec3 origin, along, across;
    double steps = 0;
    Vec3 at(double i, double j) const {
      return origin + along * (i / steps) + across * (j / steps);
    }
  };

  double steps_for(double length, double spacing, double least) const;
  double squared_to_surface(Vec3 point, double enough);
  void mark_cells(const Grid& grid, std::span<const Vec3> feet);
  bool is_marked_round(std::size_t cell, std::size_t i, std::size_t j, std::size_t steps) const;
  bool is_cell_near(const Grid& grid, double i, double j);

  const SurfaceBound& bound_;
  std::vector<std::uint8_t> cells_;  // 1: a foot lies in it
  std::uint32_t guess_ = 0;          // a triangle of the surface
};

}  // namespace meshfarm
