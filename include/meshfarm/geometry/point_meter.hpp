// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// What helps to find the nearest places soon; no distance depends on it but for `enough`.
struct PointMeterHints {
  double spacing = 0;  // of the surface's vertices, about
  double usual = 0;    // a distance that few of the points are beyond
  /// Points of the surface, at least one: no point is farther from it than from these.
  std::span<const Vec3> surface;
  /// Where above 0, all that counts is whether a distance is above this: others are told only
  /// roughly, and those above it perhaps as infinite.
  double enough = 0;
};

/// The middle of each triangle's longest side: what is far off a surface is so at its vertices or
/// there.
std::vector<Vec3> middles_of_longest_sides(std::span<const Vec3> positions,
                                           std::span<const Triangle> triangles);

/// Measures from points to a surface that is too large to be held: it is shown piece by piece, and
/// all of it once a pass. The first pass looks for what is near, the second, if any, has no limit
/// and asks only for pieces that matter.
///
///     while (meter.begin_pass()) for (each piece) if (meter.wants(its box)) meter.show(piece);
///
/// The distances depend on points and surface only, not on pieces, order or threads. Needs about 50
/// bytes a point.
class PointMeter {
 public:
  PointMeter(std::span<const Vec3> points, const PointMeterHints& hints);
  ~PointMeter();
  PointMeter(PointMeter&&) noexcept;

  /// False if every distance is known.
  bool begin_pass();
  /// Whether triangles in this box may be the nearest of a point, as far as this pass looks.
  bool wants(const Box& box) const;
  /// Several threads may show pieces at a time. Coordinates must be finite.
  void show(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  /// Of each point, once no pass is left.
  std::vector<double> distances() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
