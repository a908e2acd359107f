// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/surface_bound.hpp>

namespace meshfarm {

/// Tells whether new triangles are within a bound of a surface, by testing points of them.
///
/// Between two surfaces that are nearly parallel, the distance is greatest at a vertex of either,
/// or where two of their sides cross. So the corners and sides of a triangle are tested closely,
/// its inside only where no point of the surface is near.
class SurfaceProbe {
 public:
  /// `bound` must outlive it.
  explicit SurfaceProbe(const SurfaceBound& bound) : bound_(bound) {}

  bool is_near(Vec3 point);
  /// Tests a side, without its ends.
  bool is_side_near(Vec3 from, Vec3 to);
  /// Tests the inside of a triangle whose sides and corners are near. `feet`: points of the surface
  /// that are within the bound of this triangle, and have others near them.
  bool is_inside_near(const std::array<Vec3, 3>& triangle, std::span<const Vec3> feet);

 private:
  /// Divides a triangle into rows along its longest side.
  struct Rows {
    Vec3 origin, along, up;       // of length 1, at right angles
    double base = 0, height = 0;  // of the triangle
    double apex = 0;              // where along the base it is highest
    double count = 0;             // of the rows
    double first(double y) const { return apex * (y / height); }
    double width(double y) const { return base * (1 - y / height); }
    Vec3 at(double x, double y) const { return origin + along * x + up * y; }
  };

  static Rows rows_of(const std::array<Vec3, 3>& triangle);
  double steps_for(double length, double spacing, double most) const;
  double squared_to_surface(Vec3 point, double enough);
  void mark_cells(const Rows& rows, std::span<const Vec3> feet);
  std::size_t cell_of(double x, double y) const {
    return static_cast<std::size_t>(y / cell_) * columns_ + static_cast<std::size_t>(x / cell_);
  }
  bool is_marked_round(double x, double y) const;
  bool is_row_near(const Rows& rows, double row);
  bool is_cell_near(const Rows& rows, double share, double half, double y);

  const SurfaceBound& bound_;
  std::vector<std::uint8_t> cells_;      // 1: a foot lies in it
  std::size_t columns_ = 0, lines_ = 0;  // of cells
  double cell_ = 0;                      // their size
  std::uint32_t guess_ = 0;              // a triangle of the surface
};

}  // namespace meshfarm
