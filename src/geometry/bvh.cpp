// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/bvh_query.hpp"
#include "geometry/distance_across.hpp"

namespace meshfarm {

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

void Bvh::visit_leaf(Query& query, std::uint32_t first, std::uint32_t count) const {
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Triangle& t = mesh_.triangles[order_[i]];
    query.offer(squared_distance(query.p, mesh_.positions[t[0]], mesh_.positions[t[1]],
                                 mesh_.positions[t[2]]),
                order_[i]);
  }
}

Bvh::Nearest Bvh::nearest(Vec3 p, std::uint32_t guess, double enough) const {
  Query query(p, to_frame(p), scale_);
  const Triangle& t = mesh_.triangles[guess];
  query.offer(
      squared_distance(p, mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]),
      guess);
  BvhStack stack;
  std::size_t size = 0;
  stack[size++] = {0, 0, 0};
  while (size > 0 && query.best.squared > enough) {
    const BvhEntry top = stack[--size];
    if (top.bound >= query.limit) continue;
    if (top.count > 0) {
      visit_leaf(query, top.child, top.count);
      continue;
    }
    const Node& node = nodes_[top.child];
    query.push(node, stack, size);
  }
  return query.best;
}

/// The loop of nearest(), but what is too far is never looked at.
Bvh::Nearest Bvh::any_within(Vec3 p, double squared) const {
  Query query(p, to_frame(p), scale_);
  query.limit = query.limit_of(squared);
  BvhStack stack;
  std::size_t size = 0;
  stack[size++] = {0, 0, 0};
  while (size > 0 && !(query.best.squared <= squared)) {
    const BvhEntry top = stack[--size];
    if (top.bound >= query.limit) continue;
    if (top.count > 0) {
      visit_leaf(query, top.child, top.count);
      query.limit = std::min(query.limit, query.limit_of(squared));
      continue;
    }
    const Node& node = nodes_[top.child];
    query.push(node, stack, size);
  }
  return query.best.squared <= squared ? query.best : Nearest{};
}

}  // namespace meshfarm
