// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/exact_signs.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace meshfarm {
namespace {

/// A number as the exact sum of two doubles.
struct Two {
  double value = 0;
  double rest = 0;
};

Two sum_of(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

Two product_of(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// A sum of doubles without rounding: non-overlapping terms of increasing size (Shewchuk's
/// expansions).
class ExactSum {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Two sum = sum_of(term, terms_[i]);
      term = sum.value;
      if (sum.rest != 0) terms_[kept++] = sum.rest;
    }
    if (term != 0) terms_[kept++] = term;
    size_ = kept;
  }
  void add_product(double a, double b) {
    const Two product = product_of(a, b);
    add(product.rest);
    add(product.value);
  }
  void add_product(double a, double b, double c) {
    const Two product = product_of(a, b);
    if (product.rest != 0) add_product(product.rest, c);
    add_product(product.value, c);
  }
  int sign() const {
    if (size_ == 0) return 0;
    return terms_[size_ - 1] > 0 ? 1 : -1;
  }

 private:
  // Six products of three differences of two terms each, each product of four terms.
  std::array<double, std::size_t{6} * 8 * 4> terms_;
  std::size_t size_ = 0;
};

/// The coordinates of a vector between two points, scaled so that products stay in range.
using Differences = std::array<Two, 3>;

Differences difference(Vec3 to, Vec3 from) {
  return {sum_of(to.x, -from.x), sum_of(to.y, -from.y), sum_of(to.z, -from.z)};
}

template <std::size_t N>
double largest_of(const std::array<Differences, N>& rows) {
  double largest = 0;
  for (const Differences& row : rows) {
    for (const Two& x : row) largest = std::max(largest, std::abs(x.value));
  }
  return largest;
}

template <std::size_t N>
void scale(std::array<Differences, N>& rows, int exponent) {
  for (Differences& row : rows) {
    for (Two& x : row) x = {std::ldexp(x.value, exponent), std::ldexp(x.rest, exponent)};
  }
}

using Rows = std::array<Differences, 3>;

/// The rows must be whole numbers below 2^40.
int sign_of_integers(const Rows& rows) {
  __extension__ using Wide = __int128;
  const auto at = [&](std::size_t row, std::size_t k) -> Wide {
    return static_cast<std::int64_t>(rows[row][k].value);
  };
  Wide volume = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    volume += at(0, k) * (at(1, l) * at(2, m) - at(1, m) * at(2, l));
  }
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

bool are_integers(const Rows& rows) {
  return std::all_of(rows.begin(), rows.end(), [](const Differences& row) {
    return std::all_of(row.begin(), row.end(), [](const Two& x) {
      return x.rest == 0 && static_cast<double>(static_cast<std::int64_t>(x.value)) == x.value;
    });
  });
}

void add_product(const Two& a, const Two& b, const Two& c, double sign, ExactSum& sum) {
  for (const double x : {a.value, a.rest}) {
    if (x == 0) continue;
    for (const double y : {b.value, b.rest}) {
      if (y == 0) continue;
      for (const double z : {c.value, c.rest}) {
        if (z != 0) sum.add_product(sign * x, y, z);
      }
    }
  }
}

void add_product(const Two& a, const Two& b, double sign, ExactSum& sum) {
  for (const double x : {a.value, a.rest}) {
    for (const double y : {b.value, b.rest}) sum.add_product(sign * x, y);
  }
}

}  // namespace

int exact_side_of_plane(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a[axis] == b[axis] && b[axis] == c[axis] && c[axis] == p[axis]) return 0;
  }
  Rows rows = {difference(b, a), difference(c, a), difference(p, a)};
  const double largest = largest_of(rows);
  if (!(largest > 0)) return 0;
  // Coordinates that were floats are usually whole numbers after scaling: sums of their products
  // fit into 128 bits.
  scale(rows, 39 - std::ilogb(largest));
  if (are_integers(rows)) return sign_of_integers(rows);
  ExactSum volume;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    add_product(rows[0][k], rows[1][l], rows[2][m], 1, volume);
    add_product(rows[0][k], rows[1][m], rows[2][l], -1, volume);
  }
  return volume.sign();
}

int exact_turn(Vec3 a, Vec3 b, Vec3 c, Axes axes) {
  std::array<Differences, 2> rows = {difference(b, a), difference(c, a)};
  const double largest = largest_of(rows);
  if (!(largest > 0)) return 0;
  scale(rows, -std::ilogb(largest));
  const auto first = static_cast<std::size_t>(axes.first);
  const auto second = static_cast<std::size_t>(axes.second);
  ExactSum area;
  add_product(rows[0][first], rows[1][second], 1, area);
  add_product(rows[0][second], rows[1][first], -1, area);
  return area.sign();
}

}  // namespace meshfarm
