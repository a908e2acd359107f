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
  /// The linear index of the cell that holds `p`; points outside belong to the nearest cell.
  std::uint64_t cell_of(Vec3 p) const;
  unsigned bits() const { return bits_; }
  /// Joins eight cells to one. `bits` was above 0.
  void coarsen();
  /// Of the cell `finer` of the grid before it was coarsened, the cell that holds it now.
  std::uint64_t coarser_cell(std::uint64_t finer) const;

  /// Where `p` lies, in whole steps from the lowest corner: 2^31 steps are the longest side,
  /// however coarse the cells are. Sums of these do not depend on the order of the points.
  std::array<std::uint64_t, 3> steps_to(Vec3 p) const {
    constexpr double k_most = 4'294'967'295.0;
    const auto along = [this](double x, double lo) {
      const double steps = (x - lo) * steps_per_unit_;
      return static_cast<std::uint64_t>(
          static_cast<std::int64_t>(steps > 0 ? (steps < k_most ? steps : k_most) : 0));
    };
    return {along(p.x, lo_.x), along(p.y, lo_.y), along(p.z, lo_.z)};
  }
  /// The point that so many steps lead to, on the average of `points`.
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
