// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/divide/divided_distance.hpp>
#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/geometry/surface_sampler.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Points of the surface that is measured to: they tell where to look first.
constexpr std::uint64_t k_hints = 100'000;
/// The first pass looks as far as this multiple of the vertex spacing.
constexpr double k_near_in_spacings = 4;

SurfaceSamples sampled(const DividedSurface& surface, std::uint64_t samples) {
  SurfaceSampler sampler(samples);
  surface.show([&](std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    sampler.add(positions, triangles);
  });
  SurfaceSamples taken = sampler.take();
  if (taken.points.empty()) throw DataError("a mesh without a triangle of positive area");
  return taken;
}

}  // namespace

SurfaceError measure_error(const DividedSurface& from, const DividedSurface& to,
                           const DistanceOptions& options) {
  const SurfaceSamples points = sampled(from, options.samples);
  const SurfaceSamples hints = sampled(to, k_hints);
  const double spacing =
      std::sqrt(2 * hints.area / static_cast<double>(std::max<std::uint64_t>(1, to.triangles())));
  PointMeter meter(points.points, {spacing, k_near_in_spacings * spacing, hints.points});
  while (meter.begin_pass()) {
    to.show([&](std::span<const Vec3> positions, std::span<const Triangle> triangles) {
      Box box;
      for (const Vec3& p : positions) box.add(p);
      if (meter.wants(box)) meter.show(positions, triangles);
    });
  }
  Distance distance;
  std::vector<double> distances = meter.distances();
  for (const double d : distances) {
    distance.rms += d * d;
    distance.mean += d;
    distance.max = std::max(distance.max, d);
  }
  const auto count = static_cast<double>(distances.size());
  SurfaceError error;
  error.distance = {std::sqrt(distance.rms / count), distance.mean / count, distance.max};
  error.quantiles = quantiles_of(distances);
  return error;
}

}  // namespace meshfarm
