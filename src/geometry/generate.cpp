// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/util/errors.hpp>

// The surface uses + - * / and square roots only, all exactly rounded, so that every machine and C
// library makes the same mesh. Each ring of the torus is star-shaped about its own centre and stays
// on its own side of the axis: whatever the bumps, the surface cannot meet itself.

namespace meshfarm {
namespace {

constexpr std::uint64_t k_min_triangles = 200;
constexpr std::uint64_t k_max_triangles = std::uint64_t{1} << 48;
constexpr std::size_t k_batch = 1 << 14;

// Round the axis; the tube's own radius is 0.38 on its flat sides.
constexpr double k_ring_radius = 1;
constexpr double k_tube_radius = 0.38;
constexpr double k_bump_height = 0.22;  // at most, as a share of the tube's radius

constexpr int k_octaves = 7;
constexpr std::uint64_t k_first_rows = 10;  // cells of the first octave round the axis
constexpr std::uint64_t k_first_columns = 4;
constexpr std::uint64_t k_mask_rows = 9;
constexpr std::uint64_t k_mask_columns = 4;
constexpr double k_mask_lift = 0.15;  // rough on somewhat more than half of the surface

struct Circle {
  double cos = 1;
  double sin = 0;
};

/// cos and sin of an angle given in turns, 0 <= turn < 1: Taylor series within an eighth of a turn
/// of the nearest quarter, good to the last bits of a double.
Circle on_circle(double turn) {
  const int quarter = static_cast<int>(std::floor(turn * 4 + 0.5));
  const double x = (turn - quarter * 0.25) * 6.283185307179586476925;
  const double y = x * x;
  double c = 0, s = 0;
  for (int n = 18; n >= 2; n -= 2) {
    c = (1 - c) * y / (n * (n - 1.0));
    s = (1 - s) * y / (n * (n + 1.0));
  }
  c = 1 - c;
  s = x * (1 - s);
  switch (quarter % 4) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

double smooth_step(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

/// A fixed random number in [-1, 1) for each corner of each lattice.
double lattice_value(std::uint64_t lattice, std::uint64_t row, std::uint64_t column) {
  std::uint64_t z = (lattice * 0x9e3779b97f4a7c15U) ^ (row * 0xbf58476d1ce4e5b9U) ^
                    (column * 0x94d049bb133111ebU);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/// One row of value noise (Perlin's lattice, values in place of gradients) that closes on itself.
class NoiseRow {
 public:
  NoiseRow(std::uint64_t lattice, std::uint64_t rows, std::uint64_t columns)
      : lattice_(lattice), rows_(rows), values_(columns + 1) {}

  void set_row(double turn) {
    const double at = turn * static_cast<double>(rows_);
    const auto row = static_cast<std::uint64_t>(at);
    const double blend = smooth_step(at - static_cast<double>(row));
    for (std::size_t k = 0; k + 1 < values_.size(); ++k) {
      const double a = lattice_value(lattice_, row % rows_, k);
      const double b = lattice_value(lattice_, (row + 1) % rows_, k);
      values_[k] = a + (b - a) * blend;
    }
    values_.back() = values_.front();
  }
  /// In [-1, 1]; 0 <= turn < 1.
  double operator()(double turn) const {
    const double at = turn * static_cast<double>(values_.size() - 1);
    const auto k = static_cast<std::size_t>(at);
    const double a = values_[k], b = values_[k + 1];
    return a + (b - a) * smooth_step(at - static_cast<double>(k));
  }

 private:
  std::uint64_t lattice_;
  std::uint64_t rows_;
  std::vector<double> values_;
};

/// The surface, one ring at a time.
class Surface {
 public:
  explicit Surface(std::uint64_t columns) : mask_(0, k_mask_rows, k_mask_columns) {
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

  void add_ring(double turn, std::vector<Vec3>& vertices) {
    mask_.set_row(turn);
    for (NoiseRow& octave : octaves_) octave.set_row(turn);
    const Circle ring = on_circle(turn);
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const double swell = 1 + k_bump_height * bump(turns_[i]);
      const double radius = k_ring_radius + profile_[i].cos * swell;
      vertices.push_back(rounded({radius * ring.cos, radius * ring.sin, profile_[i].sin * swell},
                                 PositionType::float32));
    }
  }

 private:
  /// In [-1, 1]: none where the mask is not positive, more towards its heights.
  double bump(double turn) const {
    const double mask = mask_(turn) + k_mask_lift;
    if (mask <= 0) return 0;
    double sum = 0, height = 0.5;
    for (const NoiseRow& octave : octaves_) {
      sum += height * octave(turn);
      height *= 0.5;
    }
    return sum * smooth_step(std::min(1.0, 2 * mask));
  }

  NoiseRow mask_;
  std::vector<NoiseRow> octaves_;
  std::vector<double> turns_;
  std::vector<Circle> profile_;
};

struct Grid {
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
};

/// The grid nearest to so many cells among those of about the right shape; the best shape if two
/// are.
Grid nearest_grid(std::uint64_t cells) {
  constexpr double k_shape =
      k_ring_radius / k_tube_radius * 0.9;  // the square tube is longer round
  const double ideal = std::sqrt(static_cast<double>(cells) / k_shape);
  const auto middle = static_cast<std::uint64_t>(std::max(6.0, ideal));
  const std::uint64_t reach = std::min<std::uint64_t>(middle / 3 + 1, 2000);
  Grid best;
  std::uint64_t best_miss = ~std::uint64_t{0};
  for (std::uint64_t step = 0; step <= 2 * reach; ++step) {
    const std::uint64_t columns = step % 2 == 0 ? middle + step / 2 : middle - (step + 1) / 2;
    const std::uint64_t rows = (cells + columns / 2) / columns;
    const std::uint64_t miss =
        rows * columns > cells ? rows * columns - cells : cells - rows * columns;
    if (miss < best_miss) {
      best_miss = miss;
      best = {rows, columns};
    }
  }
  return best;
}

}  // namespace

BumpyTorus::BumpyTorus(std::uint64_t triangles) {
  if (triangles < k_min_triangles || triangles > k_max_triangles) {
    throw UsageError("cannot generate " + std::to_string(triangles) + " triangles: ask for " +
                     std::to_string(k_min_triangles) + " to " + std::to_string(k_max_triangles));
  }
  const Grid grid = nearest_grid(triangles / 2);
  rows_ = grid.rows;
  columns_ = grid.columns;
}

void BumpyTorus::for_vertices(const std::function<void(std::span<const Vec3>)>& take) const {
  Surface surface(columns_);
  std::vector<Vec3> batch;
  for (std::uint64_t row = 0; row < rows_; ++row) {
    surface.add_ring(static_cast<double>(row) / static_cast<double>(rows_), batch);
    if (batch.size() < k_batch && row + 1 < rows_) continue;
    take(batch);
    batch.clear();
  }
}

void BumpyTorus::for_triangles(
    const std::function<void(std::span<const std::array<std::uint64_t, 3>>)>& take) const {
  std::vector<std::array<std::uint64_t, 3>> batch;
  for (std::uint64_t row = 0; row < rows_; ++row) {
    const std::uint64_t here = row * columns_;
    const std::uint64_t next = row + 1 < rows_ ? here + columns_ : 0;
    for (std::uint64_t i = 0; i < columns_; ++i) {
      const std::uint64_t right = i + 1 < columns_ ? i + 1 : 0;
      batch.push_back({here + i, next + i, next + right});
      batch.push_back({here + i, next + right, here + right});
    }
    if (batch.size() < k_batch && row + 1 < rows_) continue;
    take(batch);
    batch.clear();
  }
}

}  // namespace meshfarm
