// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

/// The squared distance from a point to a box; 0 inside it. Never above the distance of anything in
/// the box, despite rounding.
inline double squared_gap(const Box& box, Vec3 p) {
  const auto gap = [](double lo, double hi, double x) {
    return lo > x ? lo - x : x > hi ? x - hi : 0.0;
  };
  const double x = gap(box.lo.x, box.hi.x, p.x);
  const double y = gap(box.lo.y, box.hi.y, p.y);
  const double z = gap(box.lo.z, box.hi.z, p.z);
  return x * x + y * y + z * z;
}

/// The same for two boxes.
inline double squared_gap(const Box& a, const Box& b) {
  const auto gap = [](double a_lo, double a_hi, double b_lo, double b_hi) {
    return a_lo > b_hi ? a_lo - b_hi : b_lo > a_hi ? b_lo - a_hi : 0.0;
  };
  const double x = gap(a.lo.x, a.hi.x, b.lo.x, b.hi.x);
  const double y = gap(a.lo.y, a.hi.y, b.lo.y, b.hi.y);
  const double z = gap(a.lo.z, a.hi.z, b.lo.z, b.hi.z);
  return x * x + y * y + z * z;
}

/// A triangle that is offered to points.
struct OfferedTriangle {
  Vec3 a;
  Vec3 b;
  Vec3 c;
  Box box;

  OfferedTriangle(Vec3 first, Vec3 second, Vec3 third) : a(first), b(second), c(third) {
    box.add(a);
    box.add(b);
    box.add(c);
  }

  /// Never below the gap to the box, by which triangles are skipped, so that the least of several
  /// does not depend on their order.
  double squared_from(Vec3 p) const { return squared_from(p, squared_gap(box, p)); }
  double squared_from(Vec3 p, double gap) const {
    return std::max(gap, squared_distance(p, a, b, c));
  }
};

/// A point and the squared distance of the nearest triangle offered so far. Several threads may
/// offer at once.
struct SearchingPoint {
  Vec3 place;
  std::atomic<double> squared;

  double known() const { return squared.load(std::memory_order_relaxed); }

  void offer(const OfferedTriangle& t) {
    const double now = known();
    if (now <= 0) return;
    const double gap = squared_gap(t.box, place);
    if (gap < now) take(t.squared_from(place, gap));
  }
  void take(double found) {
    double now = known();
    while (found < now && !squared.compare_exchange_weak(now, found, std::memory_order_relaxed)) {
    }
  }
};

}  // namespace meshfarm
