// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/texture/flat_overlap.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

/// Relative to the total size.
constexpr double k_slack = 1e-9;
constexpr double k_most_cells = 4096;  // per side

}  // namespace

FlatOverlaps::FlatOverlaps(std::span<const FlatTriangle> triangles)
    : triangles_(triangles), is_solid_(triangles.size()) {
  for (const FlatTriangle& t : triangles) box_.add(t);
  const Flat size = box_.hi - box_.lo;
  const double longest = std::max(size.x, size.y);
  slack_ = k_slack * longest;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    is_solid_[i] = doubled_area(triangles[i]) > 0 ? 1 : 0;
  }
  // About as many cells as triangles.
  const double cell = std::max(
      std::sqrt(size.x * size.y / std::max<double>(1, static_cast<double>(triangles.size()))),
      longest / k_most_cells);
  if (cell > 0) {
    per_cell_ = 1 / cell;
    columns_ = static_cast<std::uint32_t>(size.x * per_cell_) + 1;
    rows_ = static_cast<std::uint32_t>(size.y * per_cell_) + 1;
  }
  first_.assign(std::size_t{columns_} * rows_ + 2, 0);
  for_cells([this](std::size_t place, std::uint32_t) { ++first_[place + 2]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  items_.resize(first_.back());
  for_cells([this](std::size_t place, std::uint32_t t) { items_[first_[place + 1]++] = t; });
}

template <typename Take>
void FlatOverlaps::for_cells(const Take& take) const {
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (!is_solid_[t]) continue;
    const Range cells = cells_of(t);
    const bool is_small = cells.x1 - cells.x0 <= 1 || cells.y1 - cells.y0 <= 1;
    for (std::uint32_t y = cells.y0; y <= cells.y1; ++y) {
      for (std::uint32_t x = cells.x0; x <= cells.x1; ++x) {
        if (is_small || !cell_is_clear(t, x, y)) take(std::size_t{y} * columns_ + x, t);
      }
    }
  }
}

std::uint32_t FlatOverlaps::cell_at(double along, std::uint32_t cells) const {
  return static_cast<std::uint32_t>(
      std::clamp(along * per_cell_, 0.0, static_cast<double>(cells - 1)));
}

FlatOverlaps::Range FlatOverlaps::cells_of(std::uint32_t triangle) const {
  FlatBox box;
  box.add(triangles_[triangle]);
  return {cell_at(box.lo.x - box_.lo.x, columns_), cell_at(box.lo.y - box_.lo.y, rows_),
          cell_at(box.hi.x - box_.lo.x, columns_), cell_at(box.hi.y - box_.lo.y, rows_)};
}

/// Whether the whole cell lies on the outer side of a side of the triangle.
bool FlatOverlaps::cell_is_clear(std::uint32_t triangle, std::uint32_t x, std::uint32_t y) const {
  const FlatTriangle& t = triangles_[triangle];
  const double cell = 1 / per_cell_;
  const Flat lo{box_.lo.x + x * cell - slack_, box_.lo.y + y * cell - slack_};
  const double side = cell + 2 * slack_;
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat along = t[(k + 1) % 3] - t[k];
    // The innermost corner.
    const Flat corner{along.y < 0 ? lo.x + side : lo.x, along.x > 0 ? lo.y + side : lo.y};
    if (cross(along, corner - t[k]) < 0) return true;
  }
  return false;
}

/// Whether all of b lies on the outer side of a side of a.
bool FlatOverlaps::is_clear(const FlatTriangle& a, const FlatTriangle& b) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat along = a[(k + 1) % 3] - a[k];
    const double most =
        std::max({cross(along, b[0] - a[k]), cross(along, b[1] - a[k]), cross(along, b[2] - a[k])});
    if (most <= slack_ * length(along)) return true;
  }
  return false;
}

bool FlatOverlaps::overlap(std::uint32_t a, std::uint32_t b) const {
  return !is_clear(triangles_[a], triangles_[b]) && !is_clear(triangles_[b], triangles_[a]);
}

bool FlatOverlaps::none() const {
  const std::size_t cells = std::size_t{columns_} * rows_;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const auto items = in_cell(cell);
    for (std::size_t i = 0; i < items.size(); ++i) {
      for (std::size_t k = i + 1; k < items.size(); ++k) {
        if (overlap(items[i], items[k])) return false;
      }
    }
  }
  return true;
}

}  // namespace meshfarm
