// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/generate/generate_torus.hpp"

#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/generate.hpp>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_least_torus = 200;

// The ring's radius round the axis; the tube's radius is 0.38 on its flat sides.
constexpr double k_ring_radius = 1;
constexpr double k_tube_radius = 0.38;
constexpr double k_bump_height = 0.22;  // at most, as a share of the tube's radius

constexpr int k_octaves = 7;
constexpr std::uint64_t k_first_rows = 10;  // cells of the first octave, round the axis
constexpr std::uint64_t k_first_columns = 4;
constexpr std::uint64_t k_mask_rows = 9;
constexpr std::uint64_t k_mask_columns = 4;
constexpr double k_mask_lift = 0.15;  // rough on somewhat more than half of the surface

}  // namespace

Grid torus_grid(std::uint64_t cells) {
  constexpr double k_shape =
      k_ring_radius / k_tube_radius * 0.9;  // the square tube is longer round
  return nearest_grid(cells, k_shape);
}

TorusRings::TorusRings(std::uint64_t columns) : mask_(0, k_mask_rows, k_mask_columns) {
  for (int octave = 0; octave < k_octaves; ++octave) {
    octaves_.emplace_back(octave + 1, k_first_rows << octave, k_first_columns << octave);
  }
  for (std::uint64_t i = 0; i < columns; ++i) {
    turns_.push_back(static_cast<double>(i) / static_cast<double>(columns));
    const Circle at = on_circle(turns_.back());
    // A rounded square: c^4 + s^4 = 1 instead of c^2 + s^2 = 1.
    const double c2 = at.cos * at.cos, s2 = at.sin * at.sin;
    const double stretch = k_tube_radius / std::sqrt(std::sqrt(c2 * c2 + s2 * s2));
    profile_.push_back({at.cos * stretch, at.sin * stretch});
  }
}

void TorusRings::add_ring(double turn, double thickness, std::vector<Vec3>& ring) {
  mask_.set_row(turn);
  for (NoiseRow& octave : octaves_) octave.set_row(turn);
  const Circle axis = on_circle(turn);
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    const double swell = (1 + k_bump_height * bump(turns_[i])) * thickness;
    const double radius = k_ring_radius + profile_[i].cos * swell;
    ring.push_back({radius * axis.cos, radius * axis.sin, profile_[i].sin * swell});
  }
}

/// In [-1, 1]: 0 where the mask is not positive, larger towards its peaks.
double TorusRings::bump(double turn) const {
  const double mask = mask_(turn) + k_mask_lift;
  if (mask <= 0) return 0;
  double sum = 0, height = 0.5;
  for (const NoiseRow& octave : octaves_) {
    sum += height * octave(turn);
    height *= 0.5;
  }
  return sum * smooth_step(std::min(1.0, 2 * mask));
}

BumpyTorus::BumpyTorus(std::uint64_t triangles) {
  check_size(triangles, k_least_torus);
  const Grid grid = torus_grid(triangles / 2);
  rows_ = grid.rows;
  columns_ = grid.columns;
}

void BumpyTorus::for_vertices(const TakeVertices& take) const {
  TorusRings rings(columns_);
  Batches<Vec3> batches(take);
  std::vector<Vec3> ring;
  for (std::uint64_t row = 0; row < rows_; ++row) {
    ring.clear();
    rings.add_ring(static_cast<double>(row) / static_cast<double>(rows_), 1, ring);
    for (const Vec3& p : ring) batches.add(rounded(p, PositionType::float32));
  }
  batches.finish();
}

void BumpyTorus::for_triangles(const TakeTriangles& take) const {
  Batches<Corners> batches(take);
  for (std::uint64_t row = 0; row < rows_; ++row) {
    const std::uint64_t here = row * columns_;
    const std::uint64_t next = row + 1 < rows_ ? here + columns_ : 0;
    for (std::uint64_t i = 0; i < columns_; ++i) {
      const std::uint64_t right = i + 1 < columns_ ? i + 1 : 0;
      add_cell(batches, {here + i, next + i, next + right, here + right});
    }
  }
  batches.finish();
}

}  // namespace meshfarm
