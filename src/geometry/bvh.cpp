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
  return distance_across(p, a, b, c).squared;
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
  search(query, enough);
  return query.best;
}

Bvh::Nearest Bvh::any_within(Vec3 p, double squared) const {
  Query query(p, to_frame(p), scale_);
  query.limit = query.limit_of(squared);
  search(query, squared);
  return query.best.squared <= squared ? query.best : Nearest{};
}

void Bvh::search(Query& query, double enough) const {
  const float most = query.limit;
  BvhStack stack;
  std::size_t size = 0;
  stack[size++] = {0, 0, 0};
  while (size > 0 && query.best.squared > enough) {
    const BvhEntry top = stack[--size];
    if (top.bound >= query.limit) continue;
    if (top.count > 0) {
      visit_leaf(query, top.child, top.count);
      query.limit = std::min(query.limit, most);
      continue;
    }
    query.push(nodes_[top.child], stack, size);
  }
}

}  // namespace meshfarm
