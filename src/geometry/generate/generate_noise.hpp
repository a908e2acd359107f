// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

// The building blocks of generated shapes. They use only + - * / and square roots, all exactly
// rounded, so that every machine and C library makes the same mesh.

namespace meshfarm {

struct Circle {
  double cos = 1;
  double sin = 0;
};

/// cos and sin of an angle given in turns, 0 <= turn < 1, good to the last bits of a double.
Circle on_circle(double turn);

/// From 0 to 1 with no slope at either end.
double smooth_step(double t);

/// A fixed random number in [-1, 1) for each corner of each lattice.
double lattice_value(std::uint64_t lattice, std::uint64_t row, std::uint64_t column);

/// One row of periodic value noise (Perlin's lattice, with values in place of gradients).
class NoiseRow {
 public:
  NoiseRow(std::uint64_t lattice, std::uint64_t rows, std::uint64_t columns);
  void set_row(double turn);
  /// In [-1, 1]; 0 <= turn < 1.
  double operator()(double turn) const;

 private:
  std::uint64_t lattice_;
  std::uint64_t rows_;
  std::vector<double> values_;
};

}  // namespace meshfarm
