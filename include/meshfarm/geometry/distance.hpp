// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// Distances from area-weighted samples of one surface to the other, in the mesh's own unit.
struct Distance {
  double rms = 0;
  double mean = 0;
  double max = 0;
};

struct DistanceOptions {
  std::uint64_t samples = 400'000;
  unsigned threads = 0;  // 0: one per core. The result does not depend on it.
};

/// Samples the surface of `from` and measures the distance to the nearest point of the surface of
/// `to` (bounding volume hierarchy; one direction of the Metro measure, Cignoni et al. 1998).
/// Memory: about 20 bytes per triangle of `to`, 40 while its hierarchy is built. Throws DataError
/// if either mesh has no triangle of positive area, has coordinates that are not finite, or areas
/// that overflow; UsageError if no samples are asked for.
Distance measure_distance(const Mesh& from, const Mesh& to, const DistanceOptions& options);

/// Points that stand for a surface when the mesh itself is gone.
struct SurfaceSamples {
  double area = 0;  // of the surface; each point stands for an equal share of it
  std::vector<Vec3> points;
};

/// Samples are stratified by area; none if the mesh has no area. Throws DataError as
/// measure_distance does.
SurfaceSamples sample_surface(const Mesh& mesh, const DistanceOptions& options);

/// Measures distances from points to the surface of `to`, which must outlive it and have finite
/// coordinates and at least one triangle.
class DistanceMeter {
 public:
  DistanceMeter(const Mesh& to, unsigned threads);
  ~DistanceMeter();
  DistanceMeter(DistanceMeter&&) noexcept;
  using Points = std::span<const Vec3>;
  /// The points' distances; zeros for no points.
  Distance measure(Points points) const;
  /// The distances of each set separately, measured all at once. `of_points`, if not empty,
  /// receives those of all points in order.
  std::vector<Distance> measure_each(std::span<const Points> sets,
                                     std::span<double> of_points = {}) const;
  /// The greatest distance of the points, or `least` if none exceeds that: much cheaper than
  /// measuring them all. Uses one thread.
  double farthest(Points points, double least) const;
  /// The index of the triangle nearest to the point.
  std::uint32_t nearest_triangle(Vec3 point) const;
  /// The nearest triangle of each point, in order.
  std::vector<std::uint32_t> nearest_triangles(Points points) const;
  /// The index of `to`, for other measurements.
  const TriangleIndex& index() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
