// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/generate/generate_noise.hpp"

#include <cmath>
#include <cstddef>

namespace meshfarm {

/// Taylor series within an eighth of a turn of the nearest quarter.
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

double lattice_value(std::uint64_t lattice, std::uint64_t row, std::uint64_t column) {
  std::uint64_t z = (lattice * 0x9e3779b97f4a7c15U) ^ (row * 0xbf58476d1ce4e5b9U) ^
                    (column * 0x94d049bb133111ebU);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

NoiseRow::NoiseRow(std::uint64_t lattice, std::uint64_t rows, std::uint64_t columns)
    : lattice_(lattice), rows_(rows), values_(columns + 1) {}

void NoiseRow::set_row(double turn) {
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

double NoiseRow::operator()(double turn) const {
  const double at = turn * static_cast<double>(values_.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  const double a = values_[k], b = values_[k + 1];
  return a + (b - a) * smooth_step(at - static_cast<double>(k));
}

}  // namespace meshfarm
