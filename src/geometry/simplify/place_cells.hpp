// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A hashed grid of points, to find the nearest: faster than a k-d tree where the search radius is
/// known and the density of points is the same everywhere.
class PlaceCells {
 public:
  /// Searches no farther than `reach`. `spacing`: about how far points are from their neighbours.
  PlaceCells(std::vector<Vec3> points, double reach, double spacing)
      : points_(std::move(points)), reach_(reach) {
    for (const Vec3& p : points_) box_.add(p);
    // Each cell needs others beside it, and a place along an axis must fit in 20 bits.
    const double least = box_.diagonal() / static_cast<double>(k_axis - 4);
    cell_ = std::max({std::min(reach, k_spacings * spacing), reach / k_most_rings, least});
    if (!(cell_ > 0 && std::isfinite(cell_))) cell_ = 1;
    first_.assign(std::bit_ceil(std::max<std::size_t>(1024, points_.size())), k_none);
    next_.resize(points_.size());
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      next_[i] = std::exchange(first_[hash_of(key_of(cell_of(points_[i])))], i);
    }
  }

  /// The nearest point that counts, of equally near ones the first; nothing if none is within
  /// reach.
  template <class Counts>
  std::optional<std::uint32_t> nearest(Vec3 from, const Counts& counts) const {
    double best = reach_ * reach_;
    std::optional<std::uint32_t> found;
    // Cells farther away have no number, and without points there is no box.
    if (points_.empty() || squared_way_to_box(from) > best) return found;
    const Cell middle = cell_of(from);
    const Vec3 within = from - corner_of(middle);
    const auto look_into = [&](const Cell& offset) {
      if (squared_way(within, offset) > best) return;
      const Cell cell{middle[0] + offset[0], middle[1] + offset[1], middle[2] + offset[2]};
      for (std::uint32_t i = first_[hash_of(key_of(cell))]; i != k_none; i = next_[i]) {
        const double squared = squared_length(points_[i] - from);
        const bool is_nearer = squared < best || (squared <= best && (!found || i < *found));
        if (!is_nearer || !counts(i)) continue;
        best = squared;
        found = i;
      }
    };
    // Points in the n-th ring of cells are at least n - 1 cells away.
    for (std::int64_t ring = 0;; ++ring) {
      const double inner = static_cast<double>(ring - 1) * cell_;
      if (ring > 0 && inner * inner > best) return found;
      for_ring(ring, look_into);
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t k_none = UINT32_MAX;
  static constexpr std::int64_t k_axis = std::int64_t{1} << 20;
  static constexpr double k_spacings = 2;
  static constexpr double k_most_rings = 16;

  template <class Take>
  static void for_ring(std::int64_t ring, const Take& take) {
    for (std::int64_t z = -ring; z <= ring; ++z) {
      for (std::int64_t y = -ring; y <= ring; ++y) {
        const bool is_face = std::max(std::abs(y), std::abs(z)) == ring;
        const std::int64_t step = is_face || ring == 0 ? 1 : 2 * ring;
        for (std::int64_t x = -ring; x <= ring; x += step) {
          take({x, y, z});
        }
      }
    }
  }
  Cell cell_of(Vec3 p) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor((p[axis] - box_.lo[axis]) / cell_));
    }
    return cell;
  }
  Vec3 corner_of(const Cell& cell) const {
    return box_.lo + Vec3{static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                          static_cast<double>(cell[2])} *
                         cell_;
  }
  double squared_way_to_box(Vec3 from) const {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double way = std::max({box_.lo[axis] - from[axis], from[axis] - box_.hi[axis], 0.0});
      squared += way * way;
    }
    return squared;
  }
  /// The squared distance from a place in a cell to the cell at this offset.
  double squared_way(Vec3 within, const Cell& offset) const {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t cells = offset[static_cast<std::size_t>(axis)];
      if (cells == 0) continue;
      const double way = cells > 0 ? static_cast<double>(cells) * cell_ - within[axis]
                                   : within[axis] - static_cast<double>(cells + 1) * cell_;
      squared += way * way;
    }
    return squared;
  }
  /// Cells that are not neighbours may share a key.
  static std::uint64_t key_of(const Cell& cell) {
    return static_cast<std::uint64_t>((cell[0] * k_axis + cell[1]) * k_axis + cell[2]);
  }
  std::size_t hash_of(std::uint64_t key) const {
    return (key * 0x9e3779b97f4a7c15U >> 32) & (first_.size() - 1);
  }

  std::vector<Vec3> points_;
  double reach_;
  double cell_ = 1;
  Box box_;
  std::vector<std::uint32_t> first_;  // first point per hash, and the next after each point
  std::vector<std::uint32_t> next_;
};

}  // namespace meshfarm
