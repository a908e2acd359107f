// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Hints that speed up the search. None of them changes a distance.
struct PointMeterHints {
  double spacing = 0;  // of the surface's vertices, about
  double usual = 0;    // a distance that few points exceed
  /// Points of the surface, at least one: the distance to the nearest of them is an upper bound.
  std::span<const Vec3> surface;
  bool all_are_beyond = false;  // all exceed `usual`: skips the first pass, which looks no farther
};

Vec3 middle_of_longest_side(std::span<const Vec3> positions, const Triangle& triangle);

/// The middle of the longest side of each triangle with an area. If triangles are far from a
/// surface, usually their vertices or these points are.
std::vector<Vec3> middles_of_longest_sides(std::span<const Vec3> positions,
                                           std::span<const Triangle> triangles);

/// Only vertices of triangles with an area are part of the surface: calls `take(vertex)` for each
/// corner of these triangles.
template <typename Take>
void for_corners_with_area(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           const Take& take) {
  for (const Triangle& t : triangles) {
    if (has_no_area(positions, t)) continue;
    for (const std::uint32_t v : t) take(v);
  }
}
/// The positions of these vertices, in index order.
std::vector<Vec3> vertices_of_surface(std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles);

/// Measures distances from points to a surface that does not fit into memory. The caller shows the
/// surface piece by piece, all of it in each pass. The first pass finds what is near; a second
/// pass, if needed, has no distance limit and asks only for pieces that matter.
///
///     while (meter.begin_pass()) for (each piece) if (meter.wants(its box)) meter.show(piece);
///
/// The distances depend on points and surface only, not on pieces, order or threads. Needs about 50
/// bytes per point.
class PointMeter {
 public:
  PointMeter(std::span<const Vec3> points, const PointMeterHints& hints);
  ~PointMeter();
  PointMeter(PointMeter&&) noexcept;

  /// False if all distances are known.
  bool begin_pass();
  /// Whether triangles in this box may be the nearest to a point, as far as this pass looks.
  bool wants(const Box& box) const;
  /// Several threads may show pieces at once. Coordinates must be finite.
  void show(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  /// The distance of each point, after the last pass.
  std::vector<double> distances() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
