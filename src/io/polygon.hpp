// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// Cuts polygons into triangles along diagonals that lie inside.
class PolygonCutter {
 public:
  /// The triangles, as indices of corners: a fan from the first corner where that is correct, as
  /// for every convex polygon, else by ear clipping (Meisters, "Polygons have ears", 1975). A
  /// polygon that has no area, crosses itself or is not finite becomes a fan once there are no ears
  /// left. Valid until the next call. `corners` are at least three.
  std::span<const std::array<std::uint32_t, 3>> cut(std::span<const Vec3> corners);
  /// The number of polygons with an area for which no correct triangulation was found.
  std::uint64_t failed() const { return failed_; }

 private:
  struct Point {
    double u = 0;
    double v = 0;
    friend bool operator==(const Point&, const Point&) = default;
  };
  static double turn(Point a, Point b, Point c) {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  }
  void cut_fan(std::span<const std::uint32_t> corners);
  void project(std::span<const Vec3> corners, Vec3 normal);
  void clip_ears();
  bool is_ear(std::size_t at);

  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> left_;  // corners that are not yet cut off
  std::uint64_t tests_ = 0;          // for this polygon; limited, so that none takes for ever
  std::uint64_t failed_ = 0;
};

}  // namespace meshfarm
