// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// A uniform grid of cubic cells over a box, 2^bits along its longest side
/// (Xiong et al. 2008, 3.1 step 1; cubes, so that a flat mesh is not cut into layers).
class UniformGrid {
 public:
  static constexpr unsigned k_max_bits = 20;

  UniformGrid(const Box& box, unsigned bits);
  /// The linear index of the cell that contains `p`; points outside belong to the nearest cell.
  std::uint64_t cell_of(Vec3 p) const;
  unsigned bits() const { return bits_; }
  /// Joins each eight cells to one. `bits` must be above 0.
  void coarsen();
  /// The cell that now contains the cell `finer` of the grid before it was coarsened.
  std::uint64_t coarser_cell(std::uint64_t finer) const;

  /// The position of `p` in whole steps from the lowest corner: the longest side is 2^31 steps,
  /// however coarse the cells are. Sums of steps do not depend on the order of the points.
  std::array<std::uint64_t, 3> steps_to(Vec3 p) const {
    constexpr double k_most = 4'294'967'295.0;
    const auto along = [this](double x, double lo) {
      const double steps = (x - lo) * steps_per_unit_;
      return static_cast<std::uint64_t>(
          static_cast<std::int64_t>(steps > 0 ? (steps < k_most ? steps : k_most) : 0));
    };
    return {along(p.x, lo_.x), along(p.y, lo_.y), along(p.z, lo_.z)};
  }
  /// The average of `points` points whose steps sum up to `steps`.
  Vec3 mean_of(const std::array<std::uint64_t, 3>& steps, std::uint64_t points) const;

  void put(ByteWriter& out) const;
  static UniformGrid get(ByteReader& in);

 private:
  Vec3 lo_;
  double cells_per_unit_ = 0;
  double steps_per_unit_ = 0;
  unsigned bits_;
};

}  // namespace meshfarm
