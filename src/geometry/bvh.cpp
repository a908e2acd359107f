// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshfarm {
namespace {

double squared_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a, ap = p - a;
  const double along = dot(ap, ab), all = dot(ab, ab);
  if (!(along > 0)) return dot(ap, ap);
  if (along >= all) return squared_length(p - b);
  return squared_length(ap - ab * (along / all));
}

struct Entry {
  float bound;  // below the squared distance, in the frame
  std::uint32_t child;
  std::uint32_t count;
};

// At most three entries stay behind on each level, and a level takes at least one of 63 bits of
// code or halves the 2^32 triangles of one code.
constexpr std::size_t k_stack = 3 * (63 + 32) + 4;

}  // namespace

double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = cross(ab, ac);
  const double area = dot(normal, normal);
  // Barycentric coordinates of the projection, times `area`; negative beyond the side opposite.
  const double at_b = dot(cross(ap, ac), normal);
  const double at_c = dot(cross(ab, ap), normal);
  const double at_a = area - at_b - at_c;
  if (area > 0 && at_a >= 0 && at_b >= 0 && at_c >= 0) {
    const double height = dot(ap, normal);
    return height * height / area;
  }
  // The nearest point lies on a side that the projection is beyond. Without area take all three.
  double best = std::numeric_limits<double>::infinity();
  if (!(area > 0) || at_a < 0) best = std::min(best, squared_to_segment(p, b, c));
  if (!(area > 0) || at_b < 0) best = std::min(best, squared_to_segment(p, a, c));
  if (!(area > 0) || at_c < 0) best = std::min(best, squared_to_segment(p, a, b));
  return best;
}

/// A query keeps its point as a tiny float box that surely holds it, so that the distance between
/// boxes is a lower bound in spite of rounding.
struct Bvh::Query {
  Vec3 p;
  float lo[3];
  float hi[3];
  double to_frame;  // from squared distances in the mesh's unit
  Nearest best;
  float limit = std::numeric_limits<float>::max();

  Query(Vec3 point, Vec3 in_frame, double scale) : p(point), to_frame(scale * scale) {
    constexpr double k_far = 1e15;  // nearer is a lower bound too, and its square is a float
    for (int axis = 0; axis < 3; ++axis) {
      const float x = static_cast<float>(std::clamp(in_frame[axis], -k_far, k_far));
      const float rounding = std::fabs(x) * 0x1p-23f + std::numeric_limits<float>::min();
      lo[axis] = x - rounding;
      hi[axis] = x + rounding;
    }
  }
  void take(double squared, std::uint32_t triangle) {
    best = {squared, triangle};
    set_limit(squared);
  }
  /// Above what the rounding of a bound can make of it.
  void set_limit(double squared) {
    const double above = squared * to_frame * (1 + 0x1p-20) + std::numeric_limits<float>::min();
    limit = static_cast<float>(std::min<double>(above, std::numeric_limits<float>::max()));
  }
};

template <typename Accept>
void Bvh::offer(Query& query, std::uint32_t triangle, const Accept& accept) const {
  const Triangle& t = mesh_.triangles[triangle];
  const Vec3 a = mesh_.positions[t[0]], b = mesh_.positions[t[1]], c = mesh_.positions[t[2]];
  const double squared = squared_distance(query.p, a, b, c);
  if (squared < query.best.squared && accept(a, b, c)) query.take(squared, triangle);
}

template <typename Accept>
void Bvh::search(Query& query, double enough, const Accept& accept) const {
  std::array<Entry, k_stack> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0, 0};
  while (size > 0 && query.best.squared > enough) {
    const Entry top = stack[--size];
    if (top.bound >= query.limit) continue;
    if (top.count > 0) {
      for (std::uint32_t i = 0; i < top.count; ++i) offer(query, order_[top.child + i], accept);
      continue;
    }
    const Node& node = nodes_[top.child];
    alignas(16) float bounds[4] = {0, 0, 0, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 4; ++k) {
        const float before = node.lo[axis][k] - query.hi[axis];
        const float after = query.lo[axis] - node.hi[axis][k];
        float gap = before > after ? before : after;
        gap = gap > 0 ? gap : 0;
        bounds[k] += gap * gap;
      }
    }
    // The nearest comes to lie on top.
    const std::size_t base = size;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!(bounds[k] < query.limit)) continue;
      std::size_t at = size++;
      for (; at > base && stack[at - 1].bound < bounds[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {bounds[k], node.child[k], node.count[k]};
    }
  }
}

Bvh::Nearest Bvh::nearest(Vec3 p, std::uint32_t guess, double enough) const {
  const auto any = [](Vec3, Vec3, Vec3) { return true; };
  Query query(p, to_frame(p), scale_);
  offer(query, guess, any);
  search(query, enough, any);
  return query.best;
}

Bvh::Nearest Bvh::nearest_facing(Vec3 p, Vec3 normal, std::uint32_t guess,
                                 double most_squared) const {
  const auto faces = [normal](Vec3 a, Vec3 b, Vec3 c) {
    return dot(cross(b - a, c - a), normal) > 0;
  };
  constexpr std::uint32_t k_none = 0xffffffff;
  Query query(p, to_frame(p), scale_);
  query.best = {most_squared, k_none};
  query.set_limit(most_squared);
  offer(query, guess, faces);
  search(query, 0, faces);
  return query.best.triangle == k_none ? Nearest{} : query.best;
}

}  // namespace meshfarm
