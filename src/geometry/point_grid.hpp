// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/searching_point.hpp"

namespace meshfarm {

/// A hashed grid of points that all search equally far for their nearest triangle. Each point is
/// stored in every cell that it reaches, so that a triangle finds the points by its own cells. One
/// bit per hash tells for most cells that no point is there.
class PointGrid {
 public:
  /// `points` must outlive the grid. Cells have the requested size unless that makes too many.
  PointGrid(std::span<SearchingPoint> points, double reach, double cell);

  /// The cell of a vertex; the highest bit tells whether points may reach it.
  std::uint64_t key_of(Vec3 p) const {
    const std::uint64_t cell = cell_of(p);
    return has(cell) ? cell | k_hit : cell;
  }

  enum class Reach { none, some, many_cells };
  /// Whether points may reach a triangle whose corners have these keys; a large one lies in too
  /// many cells to tell.
  Reach reach_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) const {
    if (a == b && b == c) return (a & k_hit) != 0 ? Reach::some : Reach::none;
    const Cells cells(std::array{a, b, c});
    if (cells.count > k_most_cells) return Reach::many_cells;
    if (((a | b | c) & k_hit) != 0) return Reach::some;
    return cells.find([&](std::uint64_t cell) { return has(cell); }) ? Reach::some : Reach::none;
  }
  /// Whether triangles meet so many points that it is cheaper for each point to search for its
  /// triangle.
  bool is_crowded() const { return is_crowded_; }
  /// Offers a triangle that lies in few enough cells to the points that reach them.
  void offer(const OfferedTriangle& triangle);

 private:
  static constexpr int k_axis_bits = 21;
  static constexpr std::uint64_t k_axis = (std::uint64_t{1} << k_axis_bits) - 1;
  static constexpr std::uint64_t k_hit = std::uint64_t{1} << (3 * k_axis_bits);
  static constexpr std::uint64_t k_most_cells = 64;

  /// The cells of the box round some cells.
  struct Cells {
    std::array<std::uint64_t, 3> lo{k_axis, k_axis, k_axis};
    std::array<std::uint64_t, 3> hi{};
    std::uint64_t count = 1;  // counts above k_most_cells are capped

    template <std::size_t N>
    explicit Cells(const std::array<std::uint64_t, N>& corners) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::uint64_t corner : corners) {
          const std::uint64_t at = corner >> (axis * k_axis_bits) & k_axis;
          lo[axis] = at < lo[axis] ? at : lo[axis];
          hi[axis] = at > hi[axis] ? at : hi[axis];
        }
        count *= hi[axis] - lo[axis] + 1;
        if (count > k_most_cells) count = k_most_cells + 1;
      }
    }
    /// Whether is(cell) is true for some cell.
    template <class Is>
    bool find(Is is) const {
      for (std::uint64_t z = lo[2]; z <= hi[2]; ++z) {
        for (std::uint64_t y = lo[1]; y <= hi[1]; ++y) {
          for (std::uint64_t x = lo[0]; x <= hi[0]; ++x) {
            if (is(x | y << k_axis_bits | z << (2 * k_axis_bits))) return true;
          }
        }
      }
      return false;
    }
  };

  struct Entry {
    std::uint64_t cell = 0;
    std::uint32_t point = 0;
  };

  static std::uint64_t hash_of(std::uint64_t cell) { return cell * 0x9e3779b97f4a7c15U; }

  std::uint64_t cell_of(Vec3 p) const {
    const auto along = [&](double x, double from) {
      constexpr auto k_last = static_cast<double>(k_axis);
      const double at = (x - from) * per_unit_;
      return static_cast<std::uint64_t>(at > 0 ? at < k_last ? at : k_last : 0);
    };
    return along(p.x, origin_.x) | along(p.y, origin_.y) << k_axis_bits |
           along(p.z, origin_.z) << (2 * k_axis_bits);
  }
  bool has(std::uint64_t cell) const {
    const std::uint64_t hash = hash_of(cell);
    return (bits_[hash >> bits_shift_] >> (hash & 63) & 1) != 0;
  }

  void set_cells(double reach, double cell);
  void add_entries(double reach);

  bool find_crowds() const;

  std::span<SearchingPoint> points_;
  bool is_crowded_ = false;
  Vec3 origin_;
  double per_unit_ = 1;
  int bits_shift_ = 0;
  int bucket_shift_ = 0;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint32_t> first_;  // entry of each bucket of hashes
  std::vector<Entry> entries_;
};

}  // namespace meshfarm
