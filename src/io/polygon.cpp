// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_tests = std::uint64_t{1} << 26;

/// Twice the area, as a vector (Newell): it points to where most of the polygon is seen from.
Vec3 area_of(std::span<const Vec3> corners) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return sum;
}

/// Whether all triangles of the fan from the first corner face the same way as the polygon.
bool is_fan(std::span<const Vec3> corners, Vec3 normal) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3 area = cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    if (!(dot(area, normal) > 0)) return false;
  }
  return true;
}

}  // namespace

std::span<const std::array<std::uint32_t, 3>> PolygonCutter::cut(std::span<const Vec3> corners) {
  triangles_.clear();
  left_.resize(corners.size());
  std::iota(left_.begin(), left_.end(), 0U);
  const Vec3 normal = area_of(corners);
  const bool has_area = squared_length(normal) > 0 && is_finite(normal);
  if (!has_area || is_fan(corners, normal)) {
    cut_fan(left_);
  } else {
    project(corners, normal);
    clip_ears();
  }
  return triangles_;
}

void PolygonCutter::cut_fan(std::span<const std::uint32_t> corners) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    triangles_.push_back({corners[0], corners[i], corners[i + 1]});
  }
}

/// Projects along the axis that the polygon faces most, keeping its counter-clockwise orientation.
void PolygonCutter::project(std::span<const Vec3> corners, Vec3 normal) {
  int axis = 0;
  for (const int other : {1, 2}) {
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  }
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  points_.clear();
  for (const Vec3& p : corners) points_.push_back({p[u] - corners[0][u], p[v] - corners[0][v]});
}

void PolygonCutter::clip_ears() {
  tests_ = 0;
  std::size_t misses = 0;
  for (std::size_t at = 1; left_.size() > 3 && misses < left_.size();) {
    const std::size_t count = left_.size();
    if (is_ear(at)) {
      triangles_.push_back({left_[(at + count - 1) % count], left_[at], left_[(at + 1) % count]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
      misses = 0;
    } else {
      ++misses;
    }
    at = (at + 1) % left_.size();  // not right next to an ear: that would make slivers
  }
  if (left_.size() > 3) ++failed_;
  cut_fan(left_);
}

/// Whether the corner is convex and the triangle that it would cut off contains no other corner,
/// not even on its edge, where the remaining polygon would have no area.
bool PolygonCutter::is_ear(std::size_t at) {
  const std::size_t count = left_.size();
  const Point a = points_[left_[(at + count - 1) % count]];
  const Point b = points_[left_[at]];
  const Point c = points_[left_[(at + 1) % count]];
  if (!(turn(a, b, c) > 0)) return false;
  if ((tests_ += count) > k_most_tests) return false;
  return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t other) {
    const Point p = points_[other];
    if (p == a || p == b || p == c) return false;
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  });
}

}  // namespace meshfarm
