// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/thin_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

// Of a normal's components, those that are no less than this share of its length tell where it
// points to. The largest is 0.577 at least.
constexpr double k_points_there = 0.4;

constexpr int k_cell_bits = 20;

/// Cells of a grid, hashed, each with the ways that its triangles face: one of six bits for each
/// direction of an axis.
class FacingCells {
 public:
  FacingCells(Vec3 origin, double size) : origin_(origin), scale_(1 / size), table_(1024, 0) {
    cells_.emplace_back();
  }

  /// Returns the cell's number.
  std::uint32_t add(Vec3 p, std::uint8_t ways) {
    const Vec3 at = (p - origin_) * scale_;
    const std::uint64_t key =
        key_of({static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y),
                static_cast<std::int64_t>(at.z)});
    // As a rule that of the triangle before.
    if (cells_[last_].key != key) {
      std::uint32_t& number = find(key);
      if (number == 0) {
        number = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back({key});
      }
      last_ = number;
    }
    const std::uint32_t number = last_;
    cells_[number].ways |= ways;
    if (2 * cells_.size() > table_.size()) grow();
    return number;
  }

  /// Whether a triangle in the cell or in one beside it faces against one in the cell.
  std::vector<std::uint8_t> opposed() {
    std::vector<std::uint8_t> opposed(cells_.size(), 0);
    for (std::size_t i = 1; i < cells_.size(); ++i) {
      const std::uint64_t key = cells_[i].key;
      const std::uint8_t against = opposite(cells_[i].ways);
      if ((against & cells_[i].ways) != 0) opposed[i] = 1;
      // Keys of neighbours: none is at the end of its axis. Of two beside each other one looks.
      for (std::uint64_t k = 14; k < 27; ++k) {
        const std::uint64_t beside =
            key + (k % 3) * k_x + (k / 3 % 3) * k_y + (k / 9) * k_z - k_x - k_y - k_z;
        const std::uint32_t other = find(beside);
        if ((against & cells_[other].ways) == 0) continue;
        opposed[i] = 1;
        opposed[other] = 1;
      }
    }
    return opposed;
  }

 private:
  struct Cell {
    std::uint64_t key = 0;  // none
    std::uint8_t ways = 0;
  };
  static constexpr std::uint64_t k_x = 1;
  static constexpr std::uint64_t k_y = std::uint64_t{1} << k_cell_bits;
  static constexpr std::uint64_t k_z = std::uint64_t{1} << (2 * k_cell_bits);

  static std::uint64_t key_of(const std::array<std::int64_t, 3>& place) {
    return static_cast<std::uint64_t>(place[0] + 1) * k_x +
           static_cast<std::uint64_t>(place[1] + 1) * k_y +
           static_cast<std::uint64_t>(place[2] + 1) * k_z;
  }
  static std::uint8_t opposite(std::uint8_t ways) {
    return static_cast<std::uint8_t>((ways & 0x15U) << 1 | (ways & 0x2AU) >> 1);
  }
  /// Where the number of the cell is or would be.
  std::uint32_t& find(std::uint64_t key) {
    std::size_t place = (key * 0x9e3779b97f4a7c15U >> 32) & (table_.size() - 1);
    while (table_[place] != 0 && cells_[table_[place]].key != key) {
      place = (place + 1) & (table_.size() - 1);
    }
    return table_[place];
  }
  void grow() {
    table_.assign(2 * table_.size(), 0);
    for (std::uint32_t i = 1; i < cells_.size(); ++i) find(cells_[i].key) = i;
  }

  Vec3 origin_;
  double scale_;
  std::vector<Cell> cells_;  // from 1 on
  std::vector<std::uint32_t> table_;
  std::uint32_t last_ = 0;
};

/// A bit for each direction of an axis that a vector points to.
std::uint8_t ways_of(Vec3 n) {
  const double least = k_points_there * k_points_there * squared_length(n);
  const auto bits = [least](double x, int place) {
    return (x * x >= least ? 1 : 0) << (x > 0 ? place : place + 1);
  };
  return static_cast<std::uint8_t>(bits(n.x, 0) | bits(n.y, 2) | bits(n.z, 4));
}

}  // namespace

void flag_thin_walls(const Mesh& mesh, double reach, std::span<std::uint8_t> flags) {
  Box box;
  for (const Vec3& p : mesh.positions) {
    if (is_finite(p)) box.add(p);
  }
  const double diagonal = box.diagonal();
  if (!(reach > 0 && diagonal > 0 && std::isfinite(diagonal))) return;
  FacingCells facing(box.lo, std::max(reach, diagonal / ((1 << k_cell_bits) - 4)));
  std::vector<std::uint32_t> cell(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Vec3 p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
    const Vec3 normal = cross(q - p, r - p);
    const double squared = squared_length(normal);
    if (!(squared > 0 && std::isfinite(squared))) continue;
    cell[i] = facing.add((p + q + r) * (1.0 / 3), ways_of(normal));
  }
  const std::vector<std::uint8_t> opposed = facing.opposed();
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (opposed[cell[i]] == 0) continue;
    for (const std::uint32_t v : mesh.triangles[i]) flags[v] |= k_thin;
  }
}

}  // namespace meshfarm
