// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/geometry/piece_samples.hpp>
#include <meshfarm/geometry/weighted_values.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/area_sampler.hpp"
#include "geometry/bvh.hpp"
#include "geometry/random_unit.hpp"
#include "geometry/turned.hpp"

namespace meshfarm {

PieceSamples sample_piece(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          std::uint64_t count, Vec3 origin) {
  return sample_piece(
      positions, triangles, [count](double) { return count; }, origin);
}

PieceSamples sample_piece(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          const std::function<std::uint64_t(double area)>& count_of, Vec3 origin) {
  constexpr std::size_t k_block = 16;  // one number per triangle would take long to write
  PieceSamples made;
  std::vector<double> before;  // the area up to the end of each block
  before.reserve(triangles.size() / k_block + 1);
  const auto normal_at = [&](const Triangle& t) {
    const Vec3 a = positions[t[0]];
    return cross(positions[t[1]] - a, positions[t[2]] - a);
  };
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Vec3 normal = normal_at(triangles[i]);
    made.area += length(normal) / 2;
    made.volume += dot(positions[triangles[i][0]] - origin, normal) / 6;
    if (i % k_block == k_block - 1 || i + 1 == triangles.size()) before.push_back(made.area);
  }
  if (!(made.area > 0) || !std::isfinite(made.area)) return made;
  const std::uint64_t count = count_of(made.area);
  if (count == 0) return made;
  const double share = made.area / static_cast<double>(count);
  std::size_t block = 0;
  made.points.reserve(count);
  for (std::uint64_t n = 0; n < count; ++n) {
    const double place = (static_cast<double>(n) + random_unit(3 * n)) * share;
    const auto found = std::lower_bound(before.begin() + static_cast<std::ptrdiff_t>(block),
                                        before.end() - 1, place);
    block = static_cast<std::size_t>(found - before.begin());
    const std::size_t last = std::min(triangles.size(), (block + 1) * k_block) - 1;
    std::size_t at = block * k_block;
    Vec3 normal = normal_at(triangles[at]);
    double area = (block > 0 ? before[block - 1] : 0) + length(normal) / 2;
    while (area < place && at < last) {  // the same sums as above
      normal = normal_at(triangles[++at]);
      area += length(normal) / 2;
    }
    const auto& [first, second, third] = triangles[at];
    made.points.push_back(
        {random_place(positions[first], positions[second], positions[third], n), normal});
  }
  return made;
}

std::vector<NearPlace> find_near_places(const TriangleIndex& index,
                                        std::span<const FacingPoint> points, unsigned threads) {
  std::vector<NearPlace> places(points.size());
  const Mesh& mesh = index.mesh();
  parallel_for(chunks_of(points.size()), threads, [&](std::uint64_t chunk) {
    const std::size_t end = std::min(points.size(), (chunk + 1) * k_samples_a_chunk);
    std::uint32_t guess = 0;
    for (std::size_t i = chunk * k_samples_a_chunk; i < end; ++i) {
      const auto& [point, normal] = points[i];
      const Bvh::Nearest nearest = index.bvh().nearest(point, guess);
      guess = nearest.triangle;
      const Triangle& t = mesh.triangles[guess];
      const auto shares =
          nearest_shares(point, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
      const double degrees = degrees_turned(mesh, index.bvh(), point, normal, nearest, shares);
      places[i] = {std::sqrt(nearest.squared), guess, static_cast<float>(degrees)};
    }
  });
  return places;
}

NormalDeviation normals_of(std::span<const NearPlace> places, std::span<const double> areas) {
  std::vector<std::pair<double, double>> degrees;
  degrees.reserve(places.size());
  NormalDeviation made;
  double area = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].degrees < 0) continue;
    const auto turned = static_cast<double>(places[i].degrees);
    degrees.emplace_back(turned, areas[i]);
    area += areas[i];
    made.rms += areas[i] * turned * turned;
    if (turned > 90) made.over_90 += areas[i];
  }
  if (!(area > 0)) return {};
  made.rms = std::sqrt(made.rms / area);
  made.over_90 /= area;
  made.p95 = WeightedValues(std::move(degrees)).quantile(0.95);
  return made;
}

}  // namespace meshfarm
