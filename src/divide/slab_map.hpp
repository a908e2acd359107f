// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/sweep_order.hpp>

#include "divide/share_map.hpp"

namespace meshfarm {

/// Looks at a mesh's vertices in file order, to choose the order of the sweep.
class OrderProbe {
 public:
  void look_at(std::span<const Vec3> batch);
  /// Along the longest axis of the vertices' box. Of axes that are almost equally long, the one
  /// along which the file is already in order, if there is one; else the first.
  SweepOrder choose(const Box& box) const;

 private:
  Vec3 last_;
  bool any_ = false;
  std::array<bool, 3> rises_ = {true, true, true};
  std::array<bool, 3> falls_ = {true, true, true};
};

/// What to do with vertices at one point that are so many that they make a slab too large.
enum class AtOnePoint : std::uint8_t {
  stay,   // they stay together anyway
  merge,  // they become one vertex
  deal,   // they are dealt out, in their order, to consecutive slabs
};

/// Divides the vertices, in the order of the sweep, into slabs of about equal numbers. They are
/// counted into bins along the axis. A bin with too many for even slabs is divided into finer ones
/// between its ends, or, if all are at one coordinate, along the next axis: outliers, or many
/// vertices in one plane, make no slab larger. Memory: 7 MB, and 3 KB for each slab wanted.
class SlabMap : public ShareMap {
 public:
  SlabMap(const Box& box, const SweepOrder& order, std::uint32_t wanted, AtOnePoint at_one_point);
  std::string_view name() const override { return "slabs"; }
  void count(std::span<const Vec3> batch) override;
  bool refine() override;
  /// No slab is empty, so there may be fewer than wanted.
  std::uint32_t divide() override;
  bool merges() const override { return at_one_point_ == AtOnePoint::merge && !points_.empty(); }
  void find_targets(std::span<const Vec3> batch, ShareTargets& targets) override;

 private:
  /// Bins of equal width between two coordinates.
  struct Division {
    int rank = 0;  // of the axis: 0 is the sweep's
    double low = 0;
    double bins_per_unit = 0;
    std::uint32_t first = 0;  // of its bins
    std::uint32_t bins = 0;
  };
  /// The number of vertices, and their smallest and greatest coordinate.
  struct Bin {
    std::uint64_t count = 0;
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
  };
  struct Place {
    std::uint32_t division = 0;
    std::uint32_t bin = 0;
  };
  /// A point with too many vertices.
  struct Point {
    std::uint64_t before = 0;  // vertices that come before it
    std::uint64_t seen = 0;
    std::uint32_t slab = 0;     // its first slab
    std::uint64_t as_even = 0;  // the same, numbered as if no slab were empty
  };
  static constexpr std::uint32_t k_first_bins = 1 << 18;
  static constexpr std::uint32_t k_point = std::uint32_t{1} << 30;    // a point, otherwise a slab
  static constexpr std::uint32_t k_divided = std::uint32_t{1} << 31;  // divided, otherwise a slab

  double coordinate(int rank, Vec3 p) const {
    return rank == 0 ? order_.along(p) : p[order_.axes[static_cast<std::size_t>(rank)]];
  }
  std::uint32_t bin_of(const Division& d, Vec3 p) const {
    const double bin = (coordinate(d.rank, p) - d.low) * d.bins_per_unit;
    if (!(bin > 0)) return d.first;
    return d.first + (bin >= d.bins - 1 ? d.bins - 1 : static_cast<std::uint32_t>(bin));
  }
  /// The undivided bin of a vertex.
  Place find(Vec3 p) const {
    Place at{0, bin_of(divisions_[0], p)};
    while ((targets_[at.bin] & k_divided) != 0) {
      at.division = targets_[at.bin] & ~k_divided;
      at.bin = bin_of(divisions_[at.division], p);
    }
    return at;
  }
  void add_division(int rank, double low, double high, std::uint32_t bins);
  void divide_bin(std::uint32_t bin, int rank);
  void add_point(std::uint32_t bin);
  /// The slab of the vertex that has `vertices` before it, numbered as if none were empty.
  std::uint64_t even_slab(double vertices) const {
    return std::min(wanted_ - 1, static_cast<std::uint64_t>(vertices / static_cast<double>(all_) *
                                                            static_cast<double>(wanted_)));
  }
  ShareTargets::One target_of(std::uint32_t point);

  Box box_;
  SweepOrder order_;
  std::uint64_t wanted_;
  AtOnePoint at_one_point_;
  std::vector<Division> divisions_;
  std::uint32_t first_new_ = 0;  // divisions from here on are being counted into
  std::vector<Bin> bins_;
  std::vector<std::uint32_t> targets_;  // per bin: its slab, or what divides it
  std::vector<Point> points_;
  std::uint64_t all_ = 0;
  std::uint64_t heavy_ = 0;
  unsigned scans_ = 0;
};

}  // namespace meshfarm
