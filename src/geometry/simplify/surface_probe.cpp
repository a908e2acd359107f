// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/surface_probe.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshfarm {
namespace {

/// What is so near, as a share of the bound, need not be looked at more closely.
constexpr double k_quite_near = 0.5;
/// Points that are looked at are so far apart, in distances of the bound, but no more on a side.
constexpr double k_probe_spacing = 1.25;
constexpr double k_most_on_a_side = 32;
/// So large, in distances of the bound, is a cell.
constexpr double k_cell_size = 2;
/// In so thin triangles no cell can be told.
constexpr double k_least_angle = 1e-10;

}  // namespace

double SurfaceProbe::steps_for(double length, double spacing, double least) const {
  return std::clamp(std::ceil(length / (spacing * bound_.distance())), least, k_most_on_a_side);
}

double SurfaceProbe::squared_to_surface(Vec3 point, double enough) {
  return bound_.squared_distance_to(point, enough, guess_);
}

bool SurfaceProbe::is_near(Vec3 point) {
  const double most = bound_.distance() * bound_.distance();
  return squared_to_surface(point, most) <= most;
}

bool SurfaceProbe::is_side_near(Vec3 from, Vec3 to) {
  const double most = bound_.distance() * bound_.distance();
  const double enough = most * k_quite_near * k_quite_near;
  const Vec3 along = to - from;
  const double steps = steps_for(length(along), k_probe_spacing, 2);
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

void SurfaceProbe::mark_cells(const Grid& grid, std::span<const Vec3> feet) {
  const auto steps = static_cast<std::size_t>(grid.steps);
  cells_.assign(steps * steps, 0);
  const double aa = squared_length(grid.along), cc = squared_length(grid.across);
  const double ac = dot(grid.along, grid.across);
  const double determinant = aa * cc - ac * ac;
  if (!(determinant > k_least_angle * aa * cc)) return;
  const double scale = grid.steps / determinant;
  for (const Vec3 foot : feet) {
    const Vec3 from = foot - grid.origin;
    const double a = dot(from, grid.along), c = dot(from, grid.across);
    const double i = std::floor(std::clamp((a * cc - c * ac) * scale, 0.0, grid.steps - 1));
    const double j = std::floor(std::clamp((c * aa - a * ac) * scale, 0.0, grid.steps - 1 - i));
    cells_[static_cast<std::size_t>(i) * steps + static_cast<std::size_t>(j)] = 1;
  }
}

/// The cell or one beside it.
bool SurfaceProbe::is_marked_round(std::size_t cell, std::size_t i, std::size_t j,
                                   std::size_t steps) const {
  const bool is_last = i + j + 1 >= steps;
  return cells_[cell] != 0 || (j > 0 && cells_[cell - 1] != 0) ||
         (i > 0 && cells_[cell - steps] != 0) || (!is_last && cells_[cell + 1] != 0) ||
         (!is_last && cells_[cell + steps] != 0);
}

bool SurfaceProbe::is_inside_near(const std::array<Vec3, 3>& triangle, std::span<const Vec3> feet) {
  Grid grid{triangle[0], triangle[1] - triangle[0], triangle[2] - triangle[0]};
  const double longest =
      std::sqrt(std::max(squared_length(grid.along), squared_length(grid.across)));
  grid.steps = steps_for(longest, k_cell_size, 1);
  mark_cells(grid, feet);
  const auto steps = static_cast<std::size_t>(grid.steps);
  grid.steps *= 2;
  for (std::size_t i = 0; i < steps; ++i) {
    for (std::size_t j = 0; i + j < steps; ++j) {
      if (is_marked_round(i * steps + j, i, j, steps)) continue;
      const double x = 2.0 * static_cast<double>(i), y = 2.0 * static_cast<double>(j);
      if (!is_cell_near(grid, x, y) || !is_cell_near(grid, x + 1, y) ||
          !is_cell_near(grid, x, y + 1)) {
        return false;
      }
      if (i + j + 1 < steps && !is_cell_near(grid, x + 1, y + 1)) return false;
    }
  }
  return true;
}

/// Looks at a quarter of a cell: at its middle, and where that is not quite near at those of
/// its sides. At the triangle's third side it is half as large.
bool SurfaceProbe::is_cell_near(const Grid& grid, double i, double j) {
  const double most = bound_.distance() * bound_.distance();
  const double enough = most * k_quite_near * k_quite_near;
  const double half = i + j + 1 < grid.steps ? 0.5 : 1.0 / 3;
  const double x = i + half, y = j + half;
  const double squared = squared_to_surface(grid.at(x, y), enough);
  if (squared <= enough) return true;
  if (squared > most) return false;
  const std::array<std::pair<double, double>, 4> beside = {
      std::pair(half, 0.0), std::pair(-half, 0.0), std::pair(0.0, half), std::pair(0.0, -half)};
  return std::all_of(beside.begin(), beside.end(), [&](const std::pair<double, double>& by) {
    return squared_to_surface(grid.at(x + by.first, y + by.second), enough) <= most;
  });
}

}  // namespace meshfarm
