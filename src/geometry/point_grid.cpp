// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/point_grid.hpp"

#include <algorithm>
#include <bit>

namespace meshfarm {
namespace {

constexpr std::size_t k_least = 1024;
constexpr std::size_t k_bits_an_entry = 16;
// The average number of points per cell, seen from a point, above which the grid is crowded.
constexpr double k_crowd = 2;

}  // namespace

PointGrid::PointGrid(std::span<SearchingPoint> points, double reach, double cell)
    : points_(points) {
  set_cells(reach, cell);
  add_entries(reach);
  is_crowded_ = find_crowds();
}

/// Cells are large enough that a point reaches at most eight of them, and a key can number them
/// all.
void PointGrid::set_cells(double reach, double cell) {
  Box box;
  for (const SearchingPoint& p : points_) box.add(p.place);
  if (box.empty()) return;
  const Vec3 size = box.hi - box.lo;
  const double longest = std::max({size.x, size.y, size.z}) + 2 * reach;
  cell = std::max({cell, 2 * reach, 2 * longest / static_cast<double>(k_axis - 1)});
  per_unit_ = cell > 0 ? 1 / cell : 1;
  origin_ = box.lo - Vec3{reach, reach, reach};
}

void PointGrid::add_entries(double reach) {
  std::vector<Entry> unsorted;
  unsorted.reserve(2 * points_.size());
  const Vec3 to_corner{reach, reach, reach};
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const Vec3 p = points_[i].place;
    Cells(std::array{cell_of(p - to_corner), cell_of(p + to_corner)}).find([&](std::uint64_t cell) {
      unsorted.push_back({cell, i});
      return false;
    });
  }
  const std::size_t buckets = std::bit_ceil(std::max(k_least, unsorted.size()));
  bucket_shift_ = 64 - std::countr_zero(buckets);
  bits_.assign(std::max(k_least, buckets * k_bits_an_entry / 64), 0);
  bits_shift_ = 64 - std::countr_zero(bits_.size());
  first_.assign(buckets + 1, 0);
  for (const Entry& entry : unsorted) {
    const std::uint64_t hash = hash_of(entry.cell);
    bits_[hash >> bits_shift_] |= std::uint64_t{1} << (hash & 63);
    ++first_[(hash >> bucket_shift_) + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  entries_.resize(unsorted.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Entry& entry : unsorted) {
    entries_[next[hash_of(entry.cell) >> bucket_shift_]++] = entry;
  }
}

bool PointGrid::find_crowds() const {
  double sum = 0;
  for (std::size_t bucket = 0; bucket + 1 < first_.size(); ++bucket) {
    const double here = first_[bucket + 1] - first_[bucket];
    sum += here * here;
  }
  return sum > k_crowd * static_cast<double>(entries_.size());
}

void PointGrid::offer(const OfferedTriangle& triangle) {
  const Cells cells(std::array{cell_of(triangle.box.lo), cell_of(triangle.box.hi)});
  cells.find([&](std::uint64_t cell) {
    if (!has(cell)) return false;
    const std::uint64_t bucket = hash_of(cell) >> bucket_shift_;
    for (std::uint32_t i = first_[bucket]; i < first_[bucket + 1]; ++i) {
      if (entries_[i].cell == cell) points_[entries_[i].point].offer(triangle);
    }
    return false;
  });
}

}  // namespace meshfarm
