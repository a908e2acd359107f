// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/thin_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

// The components of a normal that are at least this share of its length tell where it points. The
// largest is at least 0.577.
constexpr double k_points_there = 0.4;

constexpr int k_cell_bits = 20;  // of a cell's place along an axis

/// The opposite directions.
std::uint8_t opposite(std::uint8_t ways) {
  return static_cast<std::uint8_t>((ways & 0x15U) << 1 | (ways & 0x2AU) >> 1);
}

/// A brick of 4 x 4 x 4 cells and a layer of cells around it, which belong to other bricks.
constexpr std::size_t k_side = 6;
using LayeredBrick = std::array<std::uint8_t, k_side * k_side * k_side>;

/// Cells of a grid, each with the directions that its triangles face: one of six bits for each
/// direction of an axis. Bricks of 4 x 4 x 4 cells, one cache line each, are hashed.
class FacingCells {
 public:
  /// Which cell of which brick.
  struct Place {
    std::uint32_t brick = 0;  // none
    std::uint8_t cell = 0;
  };

  FacingCells(Vec3 origin, double size) : origin_(origin), scale_(1 / size), table_(1024, 0) {
    bricks_.emplace_back();
    keys_.push_back({});
  }

  Place add(Vec3 p, std::uint8_t ways) {
    const Vec3 at = (p - origin_) * scale_;
    const auto x = static_cast<std::uint64_t>(at.x);
    const auto y = static_cast<std::uint64_t>(at.y);
    const auto z = static_cast<std::uint64_t>(at.z);
    const std::uint64_t key = (x / 4 + 1) * k_x + (y / 4 + 1) * k_y + (z / 4 + 1) * k_z;
    // Usually the same brick as for the triangle before.
    if (keys_[last_].key != key) last_ = find_or_add(key);
    const auto cell = static_cast<std::uint8_t>(x % 4 + 4 * (y % 4) + 16 * (z % 4));
    bricks_[last_][cell] |= ways;
    keys_[last_].ways |= ways;
    return {last_, cell};
  }

  /// Marks the cells with a triangle that another one, in the same cell or beside it, faces
  /// against.
  void find_opposed() {
    std::vector<std::uint64_t> opposed(bricks_.size(), 0);
    std::array<std::uint32_t, 27> round{};
    for (std::size_t i = 1; i < bricks_.size(); ++i) {
      std::uint8_t ways = 0;
      for (std::uint64_t k = 0; k < round.size(); ++k) {
        // Keys of neighbours: no brick is at the end of its axis.
        const std::uint64_t beside =
            keys_[i].key + (k % 3) * k_x + (k / 3 % 3) * k_y + (k / 9) * k_z - k_x - k_y - k_z;
        round[k] = find(beside);
        ways |= keys_[round[k]].ways;
      }
      if ((opposite(keys_[i].ways) & ways) != 0) opposed[i] = opposed_of(i, round);
    }
    opposed_ = std::move(opposed);
  }
  bool is_opposed(Place place) const { return (opposed_[place.brick] >> place.cell & 1U) != 0; }

 private:
  using Brick = std::array<std::uint8_t, 64>;
  struct Key {
    std::uint64_t key = 0;  // none
    std::uint8_t ways = 0;  // of all cells
  };
  static constexpr std::uint64_t k_x = 1;
  static constexpr std::uint64_t k_y = std::uint64_t{1} << k_cell_bits;
  static constexpr std::uint64_t k_z = std::uint64_t{1} << (2 * k_cell_bits);

  /// One bit per cell of the brick in the middle of 27.
  std::uint64_t opposed_of(std::size_t brick, const std::array<std::uint32_t, 27>& round) const {
    LayeredBrick ways = layered(round);
    // Adds the neighbours of each cell, along one axis after the other: only the outer layer gets
    // wrong values.
    spread<1>(ways);
    spread<k_side>(ways);
    spread<k_side * k_side>(ways);
    const Brick& own = bricks_[brick];
    std::uint64_t opposed = 0;
    for (std::size_t cell = 0; cell < own.size(); ++cell) {
      const std::size_t x = cell % 4 + 1, y = cell / 4 % 4 + 1, z = cell / 16 + 1;
      const bool is = (opposite(own[cell]) & ways[x + k_side * (y + k_side * z)]) != 0;
      opposed |= std::uint64_t{is} << cell;
    }
    return opposed;
  }

  LayeredBrick layered(const std::array<std::uint32_t, 27>& round) const {
    LayeredBrick ways{};
    for (std::size_t row = 0; row < k_side * k_side; ++row) {
      // From the first cell of the first brick, along each axis.
      const std::size_t y = row % k_side + 3, z = row / k_side + 3;
      const std::size_t brick = 3 * (y / 4) + 9 * (z / 4);
      const std::size_t cell = 4 * (y % 4) + 16 * (z % 4);
      const auto to = ways.begin() + static_cast<std::ptrdiff_t>(row * k_side);
      to[0] = bricks_[round[brick]][cell + 3];
      std::copy_n(&bricks_[round[brick + 1]][cell], 4, to + 1);
      to[5] = bricks_[round[brick + 2]][cell];
    }
    return ways;
  }
  template <std::size_t Step>
  static void spread(LayeredBrick& ways) {
    LayeredBrick spread = ways;
    for (std::size_t i = Step; i + Step < ways.size(); ++i) {
      spread[i] = ways[i - Step] | ways[i] | ways[i + Step];
    }
    ways = spread;
  }

  std::size_t place_of(std::uint64_t key) const {
    std::size_t place = key * 0x9e3779b97f4a7c15U >> shift_;
    while (table_[place] != 0 && keys_[table_[place]].key != key) {
      place = (place + 1) & (table_.size() - 1);
    }
    return place;
  }
  std::uint32_t find(std::uint64_t key) const { return table_[place_of(key)]; }
  std::uint32_t find_or_add(std::uint64_t key) {
    const std::size_t place = place_of(key);
    if (table_[place] != 0) return table_[place];
    const auto number = static_cast<std::uint32_t>(bricks_.size());
    table_[place] = number;
    bricks_.emplace_back();
    keys_.push_back({key});
    if (2 * bricks_.size() > table_.size()) grow();
    return number;
  }
  void grow() {
    table_.assign(2 * table_.size(), 0);
    --shift_;
    for (std::uint32_t i = 1; i < keys_.size(); ++i) table_[place_of(keys_[i].key)] = i;
  }

  Vec3 origin_;
  double scale_;
  std::vector<Brick> bricks_;  // from 1 on
  std::vector<Key> keys_;      // of these
  std::vector<std::uint32_t> table_;
  int shift_ = 54;                      // of hashes, to places in the table
  std::vector<std::uint64_t> opposed_;  // of each brick, one bit per cell
  std::uint32_t last_ = 0;
};

/// One bit for each direction of an axis that a vector points to.
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
  std::vector<FacingCells::Place> places(mesh.triangles.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Vec3 p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
    const Vec3 normal = cross(q - p, r - p);
    const double squared = squared_length(normal);
    if (!(squared > 0 && std::isfinite(squared))) continue;
    places[i] = facing.add((p + q + r) * (1.0 / 3), ways_of(normal));
  }
  facing.find_opposed();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!facing.is_opposed(places[i])) continue;
    for (const std::uint32_t v : mesh.triangles[i]) flags[v] |= k_thin;
  }
}

}  // namespace meshfarm
