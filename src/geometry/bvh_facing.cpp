// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT

#include "geometry/bvh_query.hpp"

namespace meshfarm {
namespace {

// From far away, all triangles may be equally near up to rounding: only this many are tried.
constexpr std::size_t k_most_from_afar = 64;

}  // namespace

// Repeats the loop of nearest(), which would be 4 % slower if it could leave triangles out.
Bvh::Nearest Bvh::nearest_facing(Vec3 p, Vec3 normal, std::uint32_t guess,
                                 double most_squared) const {
  Query query(p, to_frame(p), scale_);
  query.limit = query.limit_of(most_squared);
  const auto offer = [&](std::uint32_t triangle) {
    const auto [first, second, third] = triangles_[triangle];
    const Vec3 a = positions_[first], b = positions_[second], c = positions_[third];
    if (!(dot(cross(b - a, c - a), normal) > 0)) return;
    const double squared = squared_distance(p, a, b, c);
    if (squared < most_squared) query.offer(squared, triangle);
  };
  offer(guess);
  BvhStack stack;
  while (!stack.empty() && query.best.squared > 0) {
    const BvhStack::Entry top = stack.pop();
    if (top.bound >= query.limit) continue;
    if (top.count > 0) {
      for (std::uint32_t i = 0; i < top.count; ++i) offer(order_[top.child + i]);
      continue;
    }
    query.push(nodes_[top.child], stack);
  }
  return query.best;
}

Vec3 Bvh::most_similar_normal(Vec3 p, Vec3 normal, double squared) const {
  // The margin covers the rounding of distances to a corner or side that triangles share.
  const double reach = std::sqrt(squared) + 0x1p-40 / scale_;
  const double most_squared = reach * reach;
  const Query query(p, to_frame(p), scale_);
  const float limit = query.limit_of(most_squared);
  Vec3 best{};
  double best_cosine = -2;
  const auto look_at = [&](std::uint32_t triangle) {
    const auto [first, second, third] = triangles_[triangle];
    const Vec3 a = positions_[first], b = positions_[second], c = positions_[third];
    if (squared_distance(p, a, b, c) > most_squared) return;
    const Vec3 found = cross(b - a, c - a);
    const double all = length(found);
    if (!(all > 0)) return;
    const double cosine = dot(found, normal) / all;
    if (cosine <= best_cosine) return;
    best = found;
    best_cosine = cosine;
  };
  const bool is_far = Query::is_far(query.squared_gap_to_all(nodes_.front()));
  std::size_t left = is_far ? k_most_from_afar : triangles_.size();
  BvhStack stack;
  while (!stack.empty() && left > 0) {
    const BvhStack::Entry top = stack.pop();
    if (top.count > 0) {
      for (std::uint32_t i = 0; i < top.count; ++i) look_at(order_[top.child + i]);
      left -= std::min<std::size_t>(left, top.count);
      continue;
    }
    const Node& node = nodes_[top.child];
    float bounds[4];
    query.squared_gaps(node, bounds);
    for (std::size_t k = 0; k < 4; ++k) {
      stack.push_if(bounds[k] < limit, bounds[k], node.child[k], node.count[k]);
    }
  }
  return best;
}

}  // namespace meshfarm
