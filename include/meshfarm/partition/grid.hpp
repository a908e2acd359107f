// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

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

 private:
  Vec3 lo_;
  double cells_per_unit_ = 0;
  unsigned bits_;
};

struct Cell {
  std::uint64_t index = 0;  // linear, in the grid
  std::uint64_t vertices = 0;
  Vec3 mean;
};

/// The non-empty cells of a grid, hashed by linear index.
class CellTable {
 public:
  CellTable();
  void add(std::uint64_t cell, Vec3 position);
  /// Ends the gathering: cells in the order of their indices, which gives each its number.
  void finish();
  const std::vector<Cell>& cells() const { return cells_; }
  /// The number of a cell that was added.
  std::uint32_t number_of(std::uint64_t cell) const;

 private:
  std::size_t slot_of(std::uint64_t cell) const;
  std::size_t place_of(std::uint64_t cell);
  void grow();

  std::vector<std::uint32_t> slots_;  // number + 1; 0 is free
  std::vector<Cell> cells_;           // mean holds the sum until finish()
  std::size_t last_ = 0;              // where add() was last
};

}  // namespace meshfarm
