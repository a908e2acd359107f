// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/slab_map.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

/// Axes whose lengths differ by less than this are equally good to sweep along.
constexpr double k_as_long = 0.99;

}  // namespace

void OrderProbe::look_at(std::span<const Vec3> batch) {
  for (const Vec3& p : batch) {
    if (!has_position(p)) continue;
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

SweepOrder OrderProbe::choose(const Box& box) const {
  const Vec3 extent = box.empty() ? Vec3{} : box.hi - box.lo;
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

SlabMap::SlabMap(const Box& box, const SweepOrder& order, std::uint32_t wanted,
                 AtOnePoint at_one_point)
    : box_(box), order_(order), wanted_(std::max(1U, wanted)), at_one_point_(at_one_point) {
  const double a = box.empty() ? 0 : order.along(box.lo);
  const double b = box.empty() ? 0 : order.along(box.hi);
  add_division(0, std::min(a, b), std::max(a, b), k_first_bins);
}

void SlabMap::add_division(int rank, double low, double high, std::uint32_t bins) {
  Division division{
      .rank = rank, .low = low, .first = static_cast<std::uint32_t>(bins_.size()), .bins = bins};
  const double extent = high - low;
  if (extent > 0 && std::isfinite(extent)) division.bins_per_unit = bins / extent;
  divisions_.push_back(division);
  bins_.resize(bins_.size() + bins);
  targets_.resize(bins_.size(), 0);
}

void SlabMap::count(std::span<const Vec3> batch) {
  for (const Vec3& p : batch) {
    if (!has_position(p)) continue;
    const Place at = find(p);
    if (at.division < first_new_) continue;  // an earlier scan has counted it
    const double x = coordinate(divisions_[at.division].rank, p);
    Bin& bin = bins_[at.bin];
    ++bin.count;
    bin.low = std::min(bin.low, x);
    bin.high = std::max(bin.high, x);
  }
}

bool SlabMap::refine() {
  constexpr std::uint64_t k_bins_a_slab = 16;  // at least, so that sizes come out even
  constexpr unsigned k_most_scans = 32;        // no mesh has numbers that need more
  if (scans_++ == 0) {
    for (const Bin& bin : bins_) all_ += bin.count;
    heavy_ = std::max<std::uint64_t>(1, all_ / (k_bins_a_slab * wanted_));
  }
  const auto before = static_cast<std::uint32_t>(divisions_.size());
  if (wanted_ > 1 && scans_ < k_most_scans) {
    for (std::uint32_t d = first_new_; d < before; ++d) {
      const Division division = divisions_[d];
      for (std::uint32_t bin = division.first; bin < division.first + division.bins; ++bin) {
        if (bins_[bin].count > heavy_) divide_bin(bin, division.rank);
      }
    }
  }
  first_new_ = before;
  return divisions_.size() > before;
}

void SlabMap::divide_bin(std::uint32_t bin, int rank) {
  constexpr std::uint64_t k_bins_of_a_heavy = 4;  // at least, into which a heavy bin is divided
  std::uint32_t bins = 16;
  const std::uint64_t wanted = k_bins_of_a_heavy * (bins_[bin].count / heavy_);
  while (bins < k_first_bins && bins < wanted) bins *= 2;
  double low = bins_[bin].low;
  double high = bins_[bin].high;
  while (!(low < high)) {
    if (++rank > 2) return add_point(bin);
    const int axis = order_.axes[static_cast<std::size_t>(rank)];
    low = box_.lo[axis];
    high = box_.hi[axis];
  }
  targets_[bin] = k_divided | static_cast<std::uint32_t>(divisions_.size());
  add_division(rank, low, high, bins);
}

void SlabMap::add_point(std::uint32_t bin) {
  if (at_one_point_ == AtOnePoint::stay) return;
  if (at_one_point_ == AtOnePoint::merge && bins_[bin].count < k_crowd) return;
  targets_[bin] = k_point | static_cast<std::uint32_t>(points_.size());
  points_.emplace_back();
  if (at_one_point_ == AtOnePoint::deal) return;
  all_ -= bins_[bin].count - 1;
  bins_[bin].count = 1;
}

void SlabMap::find_targets(std::span<const Vec3> batch, ShareTargets& targets) {
  targets.fill(batch, merges(), [&](Vec3 p) {
    const std::uint32_t target = targets_[find(p).bin];
    return (target & k_point) == 0 ? ShareTargets::One{target} : target_of(target & ~k_point);
  });
}

ShareTargets::One SlabMap::target_of(std::uint32_t point) {
  Point& at = points_[point];
  if (at_one_point_ == AtOnePoint::merge) return {at.slab, point};
  const auto number = static_cast<double>(at.before + at.seen++);
  return {at.slab + static_cast<std::uint32_t>(even_slab(number + 0.5) - at.as_even)};
}

std::uint32_t SlabMap::divide() {
  std::uint64_t sum = 0;
  std::uint32_t slabs = 0;
  std::uint64_t last = 0;  // numbered as if none were empty
  const auto go_to = [&](std::uint64_t slab) {
    if (slabs == 0 || slab > last) ++slabs;
    last = slab;
  };
  const auto assign_point = [&](Point& point, std::uint64_t count) {
    point.before = sum;
    point.as_even = even_slab(static_cast<double>(sum) + 0.5);
    go_to(point.as_even);
    point.slab = slabs - 1;
    last = even_slab(static_cast<double>(sum + count) - 0.5);
    slabs += static_cast<std::uint32_t>(last - point.as_even);
    sum += count;
  };
  const auto assign = [&](std::uint32_t bin) {
    const std::uint64_t count = bins_[bin].count;
    if ((targets_[bin] & k_point) != 0) {
      return assign_point(points_[targets_[bin] & ~k_point], count);
    }
    if (count > 0) {
      // A bin belongs to the slab of its middle vertex.
      go_to(even_slab(static_cast<double>(sum) + 0.5 * static_cast<double>(count)));
      sum += count;
    }
    targets_[bin] = slabs == 0 ? 0 : slabs - 1;
  };
  // In the order of the sweep: the bins that divide a bin come in its place.
  std::vector<std::uint32_t> ahead;  // bins, the next one last
  const auto look_into = [&](const Division& d) {
    for (std::uint32_t i = d.bins; i-- > 0;) ahead.push_back(d.first + i);
  };
  look_into(divisions_[0]);
  while (!ahead.empty()) {
    const std::uint32_t bin = ahead.back();
    ahead.pop_back();
    const std::uint32_t target = targets_[bin];
    (target & k_divided) != 0 ? look_into(divisions_[target & ~k_divided]) : assign(bin);
  }
  bins_ = {};
  return slabs;
}

}  // namespace meshfarm
