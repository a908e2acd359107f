// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>

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

 private:
  Vec3 lo_;
  double cells_per_unit_ = 0;
  unsigned bits_;
};

}  // namespace meshfarm
