// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/part_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/point_meter.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_triangles_a_stray = 10;

void append(std::vector<Vec3>& points, const std::vector<Vec3>& more) {
  points.insert(points.end(), more.begin(), more.end());
}

/// The vertices of triangles; of a part some are used by boundary triangles only.
std::vector<Vec3> used_vertices(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = 1;
  }
  std::vector<Vec3> vertices;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] != 0) vertices.push_back(mesh.positions[v]);
  }
  return vertices;
}

}  // namespace

PartError::PartError(Mesh part, const SurfaceSamples& samples)
    : part_(std::move(part)), vertices_(used_vertices(part_)), surface_(samples.points) {
  append(vertices_, middles_of_longest_sides(part_.positions, part_.triangles));
  const auto triangles = static_cast<double>(std::max<std::size_t>(1, part_.triangles.size()));
  spacing_ = std::sqrt(2 * samples.area / triangles);
}

std::optional<std::vector<Vec3>> PartError::strays(const Mesh& simplified, double bound) const {
  if (simplified.triangles.empty() || surface_.empty()) return std::vector<Vec3>();
  const std::size_t most = simplified.triangles.size() / k_triangles_a_stray + 1;
  const DistanceMeter to_simplified(simplified, 1);
  std::vector<Vec3> strays = to_simplified.beyond(surface_, bound);
  if (strays.size() > most) return std::nullopt;
  append(strays, to_simplified.beyond(vertices_, bound));
  if (strays.size() > most) return std::nullopt;
  std::vector<Vec3> points =
      sample_surface(simplified, {.samples = surface_.size(), .threads = 1}).points;
  append(points, used_vertices(simplified));
  append(points, middles_of_longest_sides(simplified.positions, simplified.triangles));
  PointMeter to_part(points, {spacing_, std::min(bound, 2 * spacing_), surface_, bound});
  while (to_part.begin_pass()) to_part.show(part_.positions, part_.triangles);
  const std::vector<double> distances = to_part.distances();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (distances[i] > bound) strays.push_back(points[i]);
  }
  if (strays.size() > most) return std::nullopt;
  return strays;
}

}  // namespace meshfarm
