// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/bvh.hpp"

namespace meshfarm {

namespace {

/// Rebuilding the index takes about as long as passing over this many points per point that it has.
constexpr std::uint64_t k_worth_an_index = 8;

std::uint32_t vertex_now(const ShrinkingMesh& mesh, std::uint32_t v) {
  while (mesh.target[v] != v) v = mesh.target[v];
  return v;
}

/// The squared distance to the nearest triangle at `vertex` that has none of the vertices
/// `without`; infinite if there is none.
double squared_at(const ShrinkingMesh& mesh, std::uint32_t vertex, Vec3 from,
                  std::span<const std::uint32_t> without) {
  const auto is_without = [&](std::uint32_t v) {
    return std::binary_search(without.begin(), without.end(), v);
  };
  double least = HUGE_VAL;
  if (is_without(vertex)) return least;
  for (const Corner& c : mesh.adjacency->at(vertex)) {
    if (is_without(c.next) || is_without(c.prev)) continue;
    least = std::min(least, squared_distance(from, mesh.positions[vertex], mesh.positions[c.next],
                                             mesh.positions[c.prev]));
  }
  return least;
}

}  // namespace

double Surroundings::squared_distance(const ShrinkingMesh& mesh, const Lost& lost) {
  if (!index_) list_vertices(mesh);
  const std::span<const Vec3> points =
      lost.points.empty() ? std::span<const Vec3>(&lost.middle, 1) : lost.points;
  const auto mean = [&](double sum) { return sum / static_cast<double>(points.size()); };
  Found* const found = is_remembered(lost, points.size()) ? &found_for(mesh, lost) : nullptr;
  if (found != nullptr && std::isfinite(found->sum)) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum += squared_at(mesh, found->vertices[i], points[i], lost.without);
    }
    if (sum == found->sum) return mean(sum);
  }
  nearest_.clear();
  double sum = 0;
  for (const Vec3& point : points) {
    Nearest nearest;
    // What is nearest to one point is not far from the others.
    for (const Nearest& other : nearest_) {
      const double squared = squared_at(mesh, other.vertex, point, lost.without);
      if (squared < nearest.squared) nearest = {squared, other.vertex};
    }
    search(mesh, point, lost.without, nearest);
    nearest_.push_back(nearest);
    sum += nearest.squared;
  }
  if (found != nullptr) {
    found->sum = sum;
    for (std::size_t i = 0; i < points.size(); ++i) found->vertices[i] = nearest_[i].vertex;
  }
  return mean(sum);
}

bool Surroundings::is_remembered(const Lost& lost, std::size_t points) {
  return !lost.without.empty() && points <= Found{}.vertices.size();
}

Surroundings::Found& Surroundings::found_for(const ShrinkingMesh& mesh, const Lost& lost) {
  if (found_.size() < mesh.positions.size()) found_.resize(mesh.positions.size());
  return found_[lost.without.front()];
}

/// Finds what is nearer than the nearest so far.
void Surroundings::search(const ShrinkingMesh& mesh, Vec3 from,
                          std::span<const std::uint32_t> without, Nearest& nearest) {
  if (passed_over_ > k_worth_an_index * vertices_.size()) drop_what_is_gone(mesh);
  const auto value = [&](std::uint32_t point) {
    const std::uint32_t v = vertex_now(mesh, vertices_[point]);
    passed_over_ += mesh.adjacency->count(v) > 0 ? 0 : 1;
    const double squared = squared_at(mesh, v, from, without);
    if (squared < nearest.squared) nearest = {squared, v};
    return squared;
  };
  index_->least(from, nearest.squared, value);
}

/// Rebuilds the index without points that are gone: where most pieces go, a search would pass over
/// more and more points and find the same.
void Surroundings::drop_what_is_gone(const ShrinkingMesh& mesh) {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> vertices;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t v = vertex_now(mesh, vertices_[i]);
    if (mesh.adjacency->count(v) == 0) continue;
    points.push_back(index_->points()[i]);
    vertices.push_back(v);
  }
  vertices_ = std::move(vertices);
  index_.emplace(std::move(points));
  passed_over_ = 0;
}

void Surroundings::list_vertices(const ShrinkingMesh& mesh) {
  std::vector<Vec3> points;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.target[v] != v || mesh.adjacency->count(v) == 0) continue;
    points.push_back(mesh.positions[v]);
    vertices_.push_back(v);
  }
  add_points_inside(mesh, points);
  index_.emplace(std::move(points));
}

/// Adds points inside triangles too large for their corners to stand for them. Each point stands
/// for the nearest corner.
void Surroundings::add_points_inside(const ShrinkingMesh& mesh, std::vector<Vec3>& points) {
  constexpr std::size_t k_least_points = 30'000;
  const std::size_t corners = vertices_.size();
  const auto for_triangles = [&](const auto& visit) {
    for (std::size_t i = 0; i < corners; ++i) {
      const std::uint32_t v = vertices_[i];
      for (const Corner& c : mesh.adjacency->at(v)) {
        if (v > c.next || v > c.prev) continue;  // once per triangle
        const Vec3 p = mesh.positions[c.next] - mesh.positions[v];
        const Vec3 q = mesh.positions[c.prev] - mesh.positions[v];
        visit(Triangle{v, c.next, c.prev}, 0.5 * length(cross(p, q)));
      }
    }
  };
  double area = 0;
  for_triangles([&](const Triangle&, double of_one) { area += of_one; });
  const double of_point = area / static_cast<double>(std::max(corners, k_least_points));
  if (!(of_point > 0) || !std::isfinite(area)) return;
  for_triangles([&](const Triangle& t, double of_one) {
    const auto& [a, b, c] = t;
    const auto count = static_cast<std::uint64_t>(of_one / of_point);
    for (std::uint64_t i = 0; i < count; ++i) {
      // Spread evenly: https://extremelearning.com.au, the R2 sequence, folded into the triangle.
      const auto number = static_cast<double>(i + 1);
      double x = number * 0.7548776662466927;
      double y = number * 0.5698402909980532;
      x -= std::floor(x);
      y -= std::floor(y);
      if (x + y > 1) {
        x = 1 - x;
        y = 1 - y;
      }
      const double z = 1 - x - y;
      points.push_back(mesh.positions[a] * z + mesh.positions[b] * x + mesh.positions[c] * y);
      vertices_.push_back(z >= std::max(x, y) ? a : x >= y ? b : c);
    }
  });
}

}  // namespace meshfarm
