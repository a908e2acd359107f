// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <meshfarm/geometry/surface_bound.hpp>

#include "geometry/bvh.hpp"
#include "geometry/piece_bounder.hpp"
#include "geometry/surface_walk.hpp"

namespace meshfarm {
namespace {

/// Spacing of points inside triangles, in distances of the bound.
constexpr double k_bound_spacing = 6;
/// For shorter sides, the end points are enough.
constexpr double k_long_side = 1.5;
/// Triangles with longer sides are not small. In distances of the bound.
constexpr double k_small_side = 4;
/// Limit of points per triangle on average, for a small bound on large triangles.
constexpr double k_most_points = 4;

/// Into how many parts each side is divided; 0 if the vertices are enough.
double steps_for(double side, double spacing) {
  return side > spacing ? std::ceil(side / spacing) : 0;
}

/// The points of the used vertices, and the vertices' numbers.
std::vector<SurfacePoint> used_vertices(const Mesh& mesh, std::vector<std::uint32_t>& numbers) {
  numbers.assign(mesh.positions.size(), UINT32_MAX);
  std::vector<SurfacePoint> vertices;
  vertices.reserve(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (numbers[v] != UINT32_MAX) continue;
      numbers[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back({mesh.positions[v], t, 0});
    }
  }
  return vertices;
}

void flag_dense(const Mesh& mesh, std::span<const std::uint32_t> numbers, double distance,
                std::vector<SurfacePoint>& points) {
  for (SurfacePoint& point : points) point.is_dense = true;
  for (const Triangle& t : mesh.triangles) {
    if (longest_side(corners_of(mesh.positions, t)) <= k_small_side * distance) continue;
    for (const std::uint32_t v : t) points[numbers[v]].is_dense = false;
  }
}

/// The long sides of all triangles, one entry from each end.
class LongSides {
 public:
  LongSides(const Mesh& mesh, std::span<const std::uint32_t> numbers, double distance) {
    const double least = k_long_side * distance;
    std::vector<std::uint64_t> sides;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if (squared_length(mesh.positions[b] - mesh.positions[a]) <= least * least) continue;
        sides.push_back(std::uint64_t{numbers[a]} << 32 | numbers[b]);
        sides.push_back(std::uint64_t{numbers[b]} << 32 | numbers[a]);
      }
    }
    std::sort(sides.begin(), sides.end());
    sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
    first_.assign(numbers.size() + 1, 0);
    for (const std::uint64_t side : sides) {
      ++first_[(side >> 32) + 1];
      across_.push_back(static_cast<std::uint32_t>(side));
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  std::span<const std::uint32_t> at(std::uint32_t point) const {
    if (point + 1 >= first_.size()) return {};
    return std::span(across_).subspan(first_[point], first_[point + 1] - first_[point]);
  }

 private:
  std::vector<std::uint32_t> first_;  // of each point; one more than there are vertices
  std::vector<std::uint32_t> across_;
};

double count_inside(const Mesh& mesh, double spacing) {
  double count = 0;
  for (const Triangle& t : mesh.triangles) {
    const double steps = steps_for(longest_side(corners_of(mesh.positions, t)), spacing);
    count += steps * steps;
  }
  return count;
}

/// The centres of the triangles of a grid over a triangle.
void add_grid(const Mesh& mesh, std::uint32_t triangle, double steps,
              std::vector<SurfacePoint>& points) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3 first = mesh.positions[a];
  const Vec3 along = (mesh.positions[b] - first) * (1 / steps);
  const Vec3 across = (mesh.positions[c] - first) * (1 / steps);
  const auto share = static_cast<float>(1 / steps);
  for (double i = 0; i < steps; ++i) {
    for (double j = 0; i + j < steps; ++j) {
      points.push_back({first + along * (i + 1.0 / 3) + across * (j + 1.0 / 3), triangle, share});
      if (i + j + 1 < steps)
        points.push_back(
            {first + along * (i + 2.0 / 3) + across * (j + 2.0 / 3), triangle, -share});
    }
  }
}

std::vector<SurfacePoint> points_inside(const Mesh& mesh, double distance) {
  constexpr double k_wider = 1.2;
  const double most = k_most_points * static_cast<double>(mesh.triangles.size()) + 10'000;
  double spacing = k_bound_spacing * distance;
  while (count_inside(mesh, spacing) > most) spacing *= k_wider;
  std::vector<SurfacePoint> points;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const double steps =
        steps_for(longest_side(corners_of(mesh.positions, mesh.triangles[i])), spacing);
    if (steps > 0) add_grid(mesh, i, steps, points);
  }
  return points;
}

}  // namespace

class SurfaceBound::Impl {
 public:
  Impl(Mesh surface, const SurfaceBoundOptions& options)
      : surface_(std::move(surface)),
        options_(options),
        index_(surface_, options.threads),
        walk_(surface_),
        points_(used_vertices(surface_, numbers_)),
        sides_(surface_, numbers_, options.distance) {
    flag_dense(surface_, numbers_, options.distance, points_);
    numbers_ = {};
    const std::vector<SurfacePoint> inside = points_inside(surface_, options.distance);
    points_.insert(points_.end(), inside.begin(), inside.end());
  }

  const SurfaceBoundOptions& options() const { return options_; }
  std::span<const SurfacePoint> points() const { return points_; }
  std::span<const std::uint32_t> across_sides(std::uint32_t point) const {
    return sides_.at(point);
  }
  const Mesh& surface() const { return surface_; }
  const TriangleIndex& index() const { return index_; }
  double squared_distance_near(Vec3 point, double enough, std::uint32_t& guess) const {
    const double most = options_.distance * options_.distance;
    Bvh::Nearest found = walk_.towards(point, guess, enough);
    guess = found.triangle;
    if (found.squared <= most) return found.squared;
    found = index_.bvh().any_within(point, most);
    if (found.squared <= most) guess = found.triangle;
    return found.squared;
  }

 private:
  Mesh surface_;
  SurfaceBoundOptions options_;
  TriangleIndex index_;
  SurfaceWalk walk_;
  std::vector<std::uint32_t> numbers_;  // of vertices; while it is made
  std::vector<SurfacePoint> points_;
  LongSides sides_;
};

SurfaceBound::SurfaceBound(Mesh surface, const SurfaceBoundOptions& options)
    : impl_(std::make_unique<Impl>(std::move(surface), options)) {}
SurfaceBound::~SurfaceBound() = default;
SurfaceBound::SurfaceBound(SurfaceBound&&) noexcept = default;

const SurfaceBoundOptions& SurfaceBound::options() const {
  return impl_->options();
}
std::span<const SurfacePoint> SurfaceBound::points() const {
  return impl_->points();
}
std::span<const std::uint32_t> SurfaceBound::across_sides(std::uint32_t point) const {
  return impl_->across_sides(point);
}
const TriangleIndex& SurfaceBound::index() const {
  return impl_->index();
}
const Mesh& SurfaceBound::surface() const {
  return impl_->surface();
}
double SurfaceBound::squared_distance_near(Vec3 point, double enough, std::uint32_t& guess) const {
  return impl_->squared_distance_near(point, enough, guess);
}

}  // namespace meshfarm
