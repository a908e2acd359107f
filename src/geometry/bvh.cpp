// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/bvh_query.hpp"
#include "geometry/distance_across.hpp"
#include "geometry/searching_point.hpp"

namespace meshfarm {
namespace {

// Seen from far away, after this many triangles, one is near enough if it is as near as the mesh's
// box, up to this factor of the squared distance.
constexpr std::int64_t k_many_from_afar = 1024;
constexpr double k_as_near = 1 + 0x1p-19;

}  // namespace

double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  return distance_across(p, a, b, c).squared;
}

Vec3 Bvh::near_frame(Vec3 in_frame) {
  const auto near = [](double x) { return std::clamp(x, -k_bvh_far, k_bvh_far); };
  return {near(in_frame.x), near(in_frame.y), near(in_frame.z)};
}

double Bvh::squared_to(Vec3 p, std::uint32_t triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  return squared_distance(p, positions_[a], positions_[b], positions_[c]);
}

std::vector<std::uint32_t> Bvh::search_order(std::span<const Vec3> points) const {
  const auto place_of = [&](std::uint32_t number) { return to_curve(to_frame(points[number])); };
  std::vector<MortonItem> items(points.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) items[i] = {morton_code(place_of(i)), i};
  sort_along_curve(items, place_of);
  return numbers_of(items);
}

Bvh::Nearest Bvh::nearest(Vec3 p, std::uint32_t guess, double enough) const {
  Query query(p, to_frame(p), scale_);
  query.offer(squared_to(p, guess), guess);
  search(query, enough, [&](std::uint32_t triangle) {
    const auto& [a, b, c] = triangles_[triangle];
    return distance_across(p, positions_[a], positions_[b], positions_[c], query.best.squared)
        .squared;
  });
  return query.best;
}

Bvh::Nearest Bvh::any_within(Vec3 p, double squared) const {
  Query query(p, to_frame(p), scale_);
  query.limit = query.limit_of(squared);
  search(query, squared, [&](std::uint32_t triangle) { return squared_to(p, triangle); });
  return query.best.squared <= squared ? query.best : Nearest{};
}

double Bvh::least_below(Vec3 p, double squared) const {
  Query query(p, to_frame(p), scale_);
  query.best.squared = squared;
  query.limit = query.limit_of(squared);
  search(query, 0, [&](std::uint32_t triangle) {
    const auto& [a, b, c] = triangles_[triangle];
    return OfferedTriangle(positions_[a], positions_[b], positions_[c]).squared_from(p);
  });
  return query.best.squared;
}

template <class Distance>
void Bvh::search(Query& query, double enough, const Distance& distance) const {
  const float most = query.limit;
  std::int64_t left = k_many_from_afar;
  BvhStack stack;
  while (!stack.empty() && query.best.squared > enough) {
    const BvhStack::Entry top = stack.pop();
    if (top.bound >= query.limit) continue;
    if (top.count > 0) {
      for (std::uint32_t i = top.child; i < top.child + top.count; ++i) {
        query.offer(distance(order_[i]), order_[i]);
        if (query.best.squared <= enough) break;
      }
      query.limit = std::min(query.limit, most);
      left -= top.count;
      if (left < 0) {  // few searches get here
        left = INT64_MAX;
        const double gap = query.squared_gap_to_all(nodes_.front());
        if (Query::is_far(gap)) enough = std::max(enough, gap * k_as_near / query.to_frame);
      }
      continue;
    }
    query.push(nodes_[top.child], stack);
  }
}

}  // namespace meshfarm
