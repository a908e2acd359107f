// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "stream/sweep_order.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

/// Axes that differ by less than this are equally good to sweep along.
constexpr double k_as_long = 0.99;

}  // namespace

void OrderProbe::look_at(std::span<const Vec3> batch) {
  for (const Vec3& p : batch) {
    if (!has_position(p)) continue;
    box_.add(p);
    if (any_) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        rises_[a] = rises_[a] && p[axis] >= last_[axis];
        falls_[a] = falls_[a] && p[axis] <= last_[axis];
      }
    }
    last_ = p;
    any_ = true;
  }
}

SweepOrder OrderProbe::choose() const {
  const Vec3 extent = box_.empty() ? Vec3{} : box_.hi - box_.lo;
  const double longest = std::max({extent.x, extent.y, extent.z});
  const auto is_good = [&](int axis) { return extent[axis] >= k_as_long * longest; };
  int best = 0;
  while (best < 2 && extent[best] < longest) ++best;
  for (int axis = 2; axis >= 0; --axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (is_good(axis) && (rises_[a] || falls_[a])) best = axis;
  }
  SweepOrder order;
  const int second = best == 0 ? 1 : 0;
  order.axes = {best, second, 3 - best - second};
  const auto b = static_cast<std::size_t>(best);
  if (falls_[b] && !rises_[b]) order.sign = -1;
  return order;
}

SlabMap::SlabMap(const Box& box, const SweepOrder& order) : order_(order), counts_(k_bins, 0) {
  if (box.empty()) return;
  const double a = order.along(box.lo);
  const double b = order.along(box.hi);
  low_ = std::min(a, b);
  const double extent = std::max(a, b) - low_;
  if (extent > 0 && std::isfinite(extent)) bins_per_unit_ = k_bins / extent;
}

void SlabMap::count(std::span<const Vec3> batch) {
  for (const Vec3& p : batch) {
    if (has_position(p)) ++counts_[bin_of(p)];
  }
}

std::uint32_t SlabMap::divide(std::uint32_t wanted) {
  std::uint64_t all = 0;
  for (const std::uint64_t count : counts_) all += count;
  slab_.assign(k_bins, 0);
  std::uint64_t sum = 0;
  std::uint32_t slabs = 0;
  std::uint64_t last = 0;  // as if none were empty
  for (std::uint32_t bin = 0; bin < k_bins; ++bin) {
    if (counts_[bin] > 0) {
      // A bin belongs where its middle vertex does.
      const double middle = static_cast<double>(sum) + 0.5 * static_cast<double>(counts_[bin]);
      const auto slab = std::min<std::uint64_t>(
          wanted - 1, static_cast<std::uint64_t>(middle / static_cast<double>(all) * wanted));
      if (slabs == 0 || slab > last) ++slabs;
      last = slab;
      sum += counts_[bin];
    }
    slab_[bin] = slabs == 0 ? 0 : slabs - 1;
  }
  counts_ = {};
  return slabs;
}

}  // namespace meshfarm
