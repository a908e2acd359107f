// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <meshfarm/geometry/closer_look.hpp>

#include "geometry/piece_bounder.hpp"

namespace meshfarm {
namespace {

constexpr int k_grid_steps = 10;  // along a side
constexpr int k_round_steps = 3;
/// In longest sides: by rounding, a point of a triangle may lie outside its box.
constexpr double k_beside_box = 0x1p-20;

/// A grid of `wanted` steps along each side, or as many as allowed.
void append_grid(const CornerPoints& corners, double wanted, std::vector<Vec3>& points) {
  const int steps =
      wanted < k_grid_steps ? std::max(1, static_cast<int>(std::ceil(wanted))) : k_grid_steps;
  const auto& [a, b, c] = corners;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double of_b = static_cast<double>(i) / steps;
      const double of_c = static_cast<double>(j) / steps;
      points.push_back(a * (static_cast<double>(steps - i - j) / steps) + b * of_b + c * of_c);
    }
  }
}

/// Points of a square in the triangle's plane, as far as they are on the triangle.
void append_round(const CornerPoints& corners, Vec3 place, double radius,
                  std::vector<Vec3>& points) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = cross(b - a, c - a);
  if (!(squared_length(normal) > 0)) return;
  const Vec3 x = (b - a) * (1 / length(b - a));
  const Vec3 y = cross(normal, x) * (1 / length(normal));
  for (int i = -k_round_steps; i <= k_round_steps; ++i) {
    for (int j = -k_round_steps; j <= k_round_steps; ++j) {
      const Vec3 from_a =
          place - a + x * (radius * i / k_round_steps) + y * (radius * j / k_round_steps);
      const double of_c = dot(from_a, y) / dot(c - a, y);
      const double of_b = (dot(from_a, x) - of_c * dot(c - a, x)) / dot(b - a, x);
      if (of_b < 0 || of_c < 0 || of_b + of_c > 1) continue;
      points.push_back(a + (b - a) * of_b + (c - a) * of_c);
    }
  }
}

std::vector<Vec3> taken(std::span<const Vec3> points, std::span<const std::uint32_t> some) {
  std::vector<Vec3> taken;
  taken.reserve(some.size());
  for (const std::uint32_t i : some) taken.push_back(points[i]);
  return taken;
}

std::vector<Triangle> as_triangles(std::size_t points) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < points; ++i) triangles.push_back({i, i, i});
  return triangles;
}

}  // namespace

std::vector<std::uint32_t> farthest_points(std::span<const double> distances, std::size_t most) {
  std::vector<std::uint32_t> order(distances.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto is_farther = [&](std::uint32_t a, std::uint32_t b) {
    return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
  };
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()));
  std::partial_sort(order.begin(), end, order.end(), is_farther);
  order.erase(end, order.end());
  return order;
}

std::vector<double> heights_of_vertices(const Mesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size());
  std::vector<std::uint32_t> corners(mesh.positions.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 sum = mesh.positions[a] + mesh.positions[b] + mesh.positions[c];
    for (const std::uint32_t v : {a, b, c}) {
      sums[v] = sums[v] + (sum - mesh.positions[v]);
      ++corners[v];
    }
  }
  std::vector<double> heights(mesh.positions.size(), 0);
  for (std::size_t v = 0; v < heights.size(); ++v) {
    if (corners[v] > 0) heights[v] = length(mesh.positions[v] - sums[v] * (0.5 / corners[v]));
  }
  return heights;
}

void append_points(std::span<const Vec3> positions, const Triangle& triangle,
                   std::span<const Vec3> places, const CloserSteps& steps,
                   std::vector<Vec3>& points) {
  const CornerPoints corners = corners_of(positions, triangle);
  const double longest = longest_side(corners);
  append_grid(corners, longest / steps.step, points);
  if (longest <= k_grid_steps * steps.step || longest <= steps.radius) return;
  for (const Vec3& place : places) append_round(corners, place, steps.radius, points);
}

PlacesOfPoints::PlacesOfPoints(std::span<const Vec3> points, std::span<const std::uint32_t> some)
    : places_(taken(points, some)), cells_(places_, as_triangles(places_.size()), 0) {}

void PlacesOfPoints::append_points_of(std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles, const CloserSteps& steps,
                                      std::vector<Vec3>& points) const {
  std::vector<Vec3> here;
  for (const std::uint32_t i : cells_.touching(positions, triangles)) {
    const CornerPoints corners = corners_of(positions, triangles[i]);
    const double margin = k_beside_box * longest_side(corners);
    Box box;
    for (const Vec3& corner : corners) box.add(corner);
    box = {box.lo - Vec3{margin, margin, margin}, box.hi + Vec3{margin, margin, margin}};
    here.clear();
    std::copy_if(places_.begin(), places_.end(), std::back_inserter(here),
                 [&](const Vec3& place) { return box.contains(place); });
    if (!here.empty()) append_points(positions, triangles[i], here, steps, points);
  }
}

}  // namespace meshfarm
