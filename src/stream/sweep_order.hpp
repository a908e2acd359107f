// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/sweep_order.hpp>

namespace meshfarm {

/// Looks at a mesh's vertices in file order, to choose the order of the sweep.
class OrderProbe {
 public:
  void look_at(std::span<const Vec3> batch);
  const Box& box() const { return box_; }
  /// Along the longest axis. Of axes as good as equal in length, the one along which the file is in
  /// order already, if there is one; else the first.
  SweepOrder choose() const;

 private:
  Box box_;
  Vec3 last_;
  bool any_ = false;
  std::array<bool, 3> rises_ = {true, true, true};
  std::array<bool, 3> falls_ = {true, true, true};
};

/// Divides the extent along the axis into slabs of about equal numbers of vertices. Vertices with
/// the same coordinate are in the same slab.
class SlabMap {
 public:
  SlabMap(const Box& box, const SweepOrder& order);
  void count(std::span<const Vec3> batch);
  /// Ends the counting. Returns the number of slabs: none is empty, so that there may be fewer than
  /// wanted.
  std::uint32_t divide(std::uint32_t wanted);
  std::uint32_t slab_of(Vec3 p) const { return slab_[bin_of(p)]; }

 private:
  static constexpr std::uint32_t k_bins = 1 << 18;
  std::uint32_t bin_of(Vec3 p) const {
    const double bin = (order_.along(p) - low_) * bins_per_unit_;
    if (!(bin > 0)) return 0;
    return bin >= k_bins - 1 ? k_bins - 1 : static_cast<std::uint32_t>(bin);
  }

  SweepOrder order_;
  double low_ = 0;
  double bins_per_unit_ = 0;
  std::vector<std::uint64_t> counts_;
  std::vector<std::uint32_t> slab_;  // of each bin
};

}  // namespace meshfarm
