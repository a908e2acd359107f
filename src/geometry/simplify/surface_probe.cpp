// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/surface_probe.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshfarm {
namespace {

/// Points nearer than this share of the bound need no closer look.
constexpr double k_quite_near = 0.5;
/// Spacing of the tested points on a side, in units of the bound, and the maximum number of steps.
constexpr double k_probe_spacing = 1.25;
constexpr double k_most_probes = 32;
/// The same inside triangles, within a row and between rows, and the maximum number of either.
constexpr double k_row_spacing = 1;
constexpr double k_most_rows = 64;
/// Size of a cell, in units of the bound, and its minimum as a share of the base.
constexpr double k_cell_size = 2;
constexpr double k_least_cell = 1.0 / 32;
/// Triangles lower than this share of their base are tested along their sides only.
constexpr double k_flat_height = 1e-6;

}  // namespace

double SurfaceProbe::steps_for(double length, double spacing, double most) const {
  return std::clamp(std::ceil(length / (spacing * bound_.distance())), 1.0, most);
}

double SurfaceProbe::squared_to_surface(Vec3 point, double enough) {
  return bound_.squared_distance_near(point, enough, guess_);
}

bool SurfaceProbe::is_near(Vec3 point) {
  const double most = bound_.distance() * bound_.distance();
  return squared_to_surface(point, most) <= most;
}

bool SurfaceProbe::is_side_near(Vec3 from, Vec3 to) {
  const double most = bound_.distance() * bound_.distance();
  const double enough = most * k_quite_near * k_quite_near;
  const Vec3 along = to - from;
  const double steps = std::max(2.0, steps_for(length(along), k_probe_spacing, k_most_probes));
  const auto squared_at = [&](double i) {
    return squared_to_surface(from + along * (i / steps), enough);
  };
  for (double i = 1; i < steps; ++i) {
    const double squared = squared_at(i);
    if (squared > most) return false;
    if (squared <= enough) continue;
    if (squared_at(i - 0.5) > most || squared_at(i + 0.5) > most) return false;
  }
  return true;
}

SurfaceProbe::Rows SurfaceProbe::rows_of(const std::array<Vec3, 3>& triangle) {
  std::size_t first = 0;
  double most = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double squared = squared_length(triangle[(i + 1) % 3] - triangle[i]);
    if (!(squared > most)) continue;
    most = squared;
    first = i;
  }
  Rows rows{triangle[first], triangle[(first + 1) % 3] - triangle[first],
            triangle[(first + 2) % 3] - triangle[first]};
  rows.base = std::sqrt(most);
  if (!(rows.base > 0)) return rows;
  rows.along = rows.along * (1 / rows.base);
  rows.apex = dot(rows.up, rows.along);
  rows.up = rows.up - rows.along * rows.apex;
  rows.height = length(rows.up);
  if (rows.height > 0) rows.up = rows.up * (1 / rows.height);
  return rows;
}

void SurfaceProbe::mark_cells(const Rows& rows, std::span<const Vec3> feet) {
  cell_ = std::max(k_cell_size * bound_.distance(), rows.base * k_least_cell);
  columns_ = static_cast<std::size_t>(rows.base / cell_) + 1;
  lines_ = static_cast<std::size_t>(rows.height / cell_) + 1;
  cells_.assign(columns_ * lines_, 0);
  for (const Vec3 foot : feet) {
    const Vec3 from = foot - rows.origin;
    const double x = std::clamp(dot(from, rows.along), 0.0, rows.base);
    const double y = std::clamp(dot(from, rows.up), 0.0, rows.height);
    cells_[cell_of(x, y)] = 1;
  }
}

/// Whether the cell or one beside it is marked.
bool SurfaceProbe::is_marked_round(double x, double y) const {
  const auto column = static_cast<std::size_t>(x / cell_);
  const auto line = static_cast<std::size_t>(y / cell_);
  const std::size_t cell = cell_of(x, y);
  return cells_[cell] != 0 || (column > 0 && cells_[cell - 1] != 0) ||
         (line > 0 && cells_[cell - columns_] != 0) ||
         (column + 1 < columns_ && cells_[cell + 1] != 0) ||
         (line + 1 < lines_ && cells_[cell + columns_] != 0);
}

bool SurfaceProbe::is_inside_near(const std::array<Vec3, 3>& triangle, std::span<const Vec3> feet) {
  Rows rows = rows_of(triangle);
  if (!(rows.height > k_flat_height * rows.base)) return true;
  rows.count = steps_for(rows.height, k_row_spacing, k_most_rows);
  mark_cells(rows, feet);
  for (double row = 0; row < rows.count; ++row) {
    if (!is_row_near(rows, row)) return false;
  }
  return true;
}

/// Every other row is tested backwards, so that each place is near the last.
bool SurfaceProbe::is_row_near(const Rows& rows, double row) {
  const double y = rows.height * ((row + 0.5) / rows.count);
  const double steps = steps_for(rows.width(y), k_row_spacing, k_most_rows);
  const bool is_back = std::fmod(row, 2) > 0;
  for (double i = 0; i < steps; ++i) {
    const double share = ((is_back ? steps - 1 - i : i) + 0.5) / steps;
    if (is_marked_round(rows.first(y) + rows.width(y) * share, y)) continue;
    if (!is_cell_near(rows, share, 0.5 / steps, y)) return false;
  }
  return true;
}

/// Tests the middle of the cell and, if that is not quite near, the middles of its sides.
bool SurfaceProbe::is_cell_near(const Rows& rows, double share, double half, double y) {
  const double most = bound_.distance() * bound_.distance();
  const double enough = most * k_quite_near * k_quite_near;
  const auto squared_at = [&](double of_width, double up) {
    return squared_to_surface(rows.at(rows.first(up) + rows.width(up) * of_width, up), enough);
  };
  const double squared = squared_at(share, y);
  if (squared <= enough) return true;
  const double half_row = 0.5 * rows.height / rows.count;
  return squared <= most && squared_at(share - half, y) <= most &&
         squared_at(share + half, y) <= most && squared_at(share, y - half_row) <= most &&
         squared_at(share, y + half_row) <= most;
}

}  // namespace meshfarm
