// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/beyond_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/near_cells.hpp>
#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/geometry/vertices.hpp>

namespace meshfarm {
namespace {

/// Points of a surface, and the triangles that they are of.
struct PointsOfTriangles {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> triangles;

  void add(Vec3 point, std::uint32_t triangle) {
    points.push_back(point);
    triangles.push_back(triangle);
  }
};

/// The corners of a grid that divides the triangle, but for its own.
void add_grid(const Mesh& mesh, std::uint32_t triangle, double distance,
              PointsOfTriangles& points) {
  constexpr double k_spacing = 0.5;  // in distances
  constexpr double k_least = 3;
  constexpr double k_most = 10;
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
  const double longest =
      std::sqrt(std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)}));
  const double steps = std::clamp(std::ceil(longest / (k_spacing * distance)), k_least, k_most);
  const Vec3 along = (b - a) * (1 / steps);
  const Vec3 across = (c - a) * (1 / steps);
  for (double i = 0; i <= steps; ++i) {
    for (double j = 0; i + j <= steps; ++j) {
      const bool is_corner = i == steps || j == steps || i + j == 0;
      if (!is_corner) points.add(a + along * i + across * j, triangle);
    }
  }
}

PointsOfTriangles points_of(const Mesh& mesh, PointsInside inside, double distance) {
  PointsOfTriangles found;
  std::vector<std::uint8_t> is_there(mesh.positions.size(), 0);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (has_no_area(mesh.positions, t)) continue;
    for (const std::uint32_t v : t) {
      if (std::exchange(is_there[v], 1) == 0) found.add(mesh.positions[v], i);
    }
    found.add(middle_of_longest_side(mesh.positions, t), i);
    if (inside == PointsInside::some) add_grid(mesh, i, distance, found);
  }
  return found;
}

}  // namespace

Mesh part_beyond(const Mesh& from, PointsInside points, const Mesh& to, double distance,
                 unsigned threads) {
  if (to.triangles.empty()) return {};
  const PointsOfTriangles all = points_of(from, points, distance);
  const DistanceMeter meter(to, threads);
  if (!(meter.farthest(all.points, distance) > distance)) return {};
  std::vector<double> distances(all.points.size());
  const std::array<DistanceMeter::Points, 1> set = {all.points};
  meter.measure_each(set, distances);
  std::vector<Triangle> beyond;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if (distances[i] > distance) beyond.push_back(from.triangles[all.triangles[i]]);
  }
  Mesh part;
  append_surface(from.positions, beyond, part);
  return part;
}

void clear_near(const Mesh& surface, double distance, const std::vector<Vec3>& positions,
                std::vector<std::uint8_t>& flags) {
  if (surface.triangles.empty()) return;
  const NearCells near(surface.positions, surface.triangles, distance);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (near.touch({positions[v], positions[v]})) flags[v] = 0;
  }
}

}  // namespace meshfarm
