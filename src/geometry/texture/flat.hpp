// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

namespace meshfarm {

/// A point or a direction in a plane.
struct Flat {
  double x = 0;
  double y = 0;

  friend Flat operator+(Flat a, Flat b) { return {a.x + b.x, a.y + b.y}; }
  friend Flat operator-(Flat a, Flat b) { return {a.x - b.x, a.y - b.y}; }
  friend Flat operator*(Flat a, double s) { return {a.x * s, a.y * s}; }
  friend bool operator==(const Flat&, const Flat&) = default;
};

inline double dot(Flat a, Flat b) {
  return a.x * b.x + a.y * b.y;
}
/// Positive if b is to the left of a.
inline double cross(Flat a, Flat b) {
  return a.x * b.y - a.y * b.x;
}
inline double length(Flat a) {
  return std::sqrt(dot(a, a));
}

using FlatTriangle = std::array<Flat, 3>;

inline double doubled_area(const FlatTriangle& t) {
  return cross(t[1] - t[0], t[2] - t[0]);
}

struct FlatBox {
  Flat lo{HUGE_VAL, HUGE_VAL};
  Flat hi{-HUGE_VAL, -HUGE_VAL};

  void add(Flat p) {
    lo = {p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y};
    hi = {p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y};
  }
  void add(const FlatTriangle& t) {
    for (const Flat& p : t) add(p);
  }
};

}  // namespace meshfarm
