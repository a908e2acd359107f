// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify_rank.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/collapse.hpp"
#include "geometry/simplify_clean.hpp"

namespace meshfarm {
namespace {

// Edges whose costs differ by less than 3 % are taken in order of their vertices, which costs
// nothing measurable and walks through memory in its order.
constexpr unsigned k_bucket_shift = 15;
std::uint32_t bucket_of(CostKey key) {
  return key >> k_bucket_shift;
}

// About 40,000 edges give the rank to a per cent.
constexpr std::uint32_t k_sampled_vertices = 16384;

// Scrambled, so that a sample follows no pattern of the numbering.
std::uint32_t scrambled(std::uint32_t vertex) {
  return vertex * 2654435769U;
}

}  // namespace

CostKey key_of(double cost) {
  return static_cast<CostKey>(std::bit_cast<std::uint64_t>(cost) >> 32);
}

double cost_of(CostKey key) {
  if (key >= k_any_cost) return HUGE_VAL;
  return std::bit_cast<double>(static_cast<std::uint64_t>(key) << 32 | 0xFFFFFFFFU);
}

void EdgeRanking::begin_pass(const RankingInput& input) {
  input_ = input;
  quadrics_.assign(input_.positions.size(), {});
  sum_planes();
  sum_border_planes();
}

void EdgeRanking::sum_planes() {
  for (const Triangle& t : input_.triangles) {
    const Vec3 p = input_.positions[t[0]];
    const Vec3 n = cross(input_.positions[t[1]] - p, input_.positions[t[2]] - p);
    const double twice_area = length(n);
    if (!(twice_area > 0 && std::isfinite(twice_area))) continue;
    Quadric plane;
    plane.add(n, 0.5 / twice_area);
    for (const std::uint32_t v : t) quadrics_[v] = quadrics_[v] + plane;
  }
}

void EdgeRanking::sum_border_planes() {
  for (std::uint32_t v = 0; v < input_.flags.size(); ++v) {
    if ((input_.flags[v] & (k_border | k_fixed)) != k_border) continue;
    const Vec3 at = input_.positions[v];
    for_border_edges(input_.adjacency->at(v), [&](const Corner& c, std::uint32_t end) {
      const Vec3 normal = cross(input_.positions[c.next] - at, input_.positions[c.prev] - at);
      add_border_plane(quadrics_[v], normal, input_.positions[end] - at);
    });
  }
}

/// Calls take(a, b) for each edge that may collapse at its smaller end.
template <typename Take>
inline void EdgeRanking::for_edges_at(std::uint32_t vertex, const Take& take) const {
  const std::uint8_t flags = input_.flags[vertex];
  if ((flags & k_fixed) != 0) return;
  const std::span<const Corner> fan = input_.adjacency->at(vertex);
  const auto consider = [&](std::uint32_t end) {
    const std::uint8_t other = input_.flags[end];
    if (end < vertex || (other & k_fixed) != 0) return;
    if (input_.seam_only && ((flags | other) & k_seam) == 0) return;
    if (fan.size() + input_.adjacency->count(end) > k_max_star) return;
    take(vertex, end);
  };
  if ((flags & k_border) == 0) {
    for (const Corner& c : fan) consider(c.next);
    return;
  }
  // An inner edge between two borders may not collapse: it would pinch the surface.
  for (const Corner& c : fan) {
    if ((input_.flags[c.next] & k_border) == 0) consider(c.next);
  }
  for_border_edges(fan, [&](const Corner&, std::uint32_t end) { consider(end); });
}

/// The costs of an edge at the position that it will probably get.
inline EdgeRanking::Costs EdgeRanking::costs(std::uint32_t a, std::uint32_t b) const {
  const Vec3 half = (input_.positions[b] - input_.positions[a]) * 0.5;
  const Quadric& at_a = quadrics_[a];
  const Quadric& at_b = quadrics_[b];
  const std::uint8_t only_one = (input_.flags[a] ^ input_.flags[b]) & k_border;
  EdgeQuadric q;
  q.squared_length = 4 * squared_length(half);
  q.a = at_a + at_b;
  if (only_one != 0) {
    const bool to_a = (input_.flags[a] & k_border) != 0;
    q.c = 4 * dot((to_a ? at_b : at_a) * half, half);
    return {q.least_cost({}), q.ranking_cost(q.least_cost({}))};
  }
  q.b = (at_b - at_a) * half;
  q.c = dot(q.a * half, half);
  const double least = q.least_cost(q.best());
  return {least, q.ranking_cost(least)};
}

CostKey EdgeRanking::estimate_limit(double share, double most) {
  const auto vertices = static_cast<std::uint32_t>(input_.positions.size());
  const std::uint32_t one_in = std::max(1U, vertices / k_sampled_vertices);
  starts_.assign(bucket_of(k_any_cost) + 1, 0);
  std::uint64_t sampled = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (scrambled(v) > UINT32_MAX / one_in) continue;
    for_edges_at(v, [&](std::uint32_t a, std::uint32_t b) {
      const Costs cost = costs(a, b);
      if (!std::isfinite(cost.ranking)) return;
      ++starts_[bucket_of(key_of(cost.ranking))];
      ++sampled;
    });
  }
  const double wanted = std::min(share * static_cast<double>(sampled), most / one_in);
  std::uint64_t sum = 0;
  for (std::uint32_t bucket = 0; bucket < starts_.size(); ++bucket) {
    sum += starts_[bucket];
    if (sum > 0 && static_cast<double>(sum) >= wanted) return ((bucket + 1) << k_bucket_shift) - 1;
  }
  return k_any_cost;
}

std::span<const RankedEdge> EdgeRanking::cheapest(std::uint32_t first, std::uint32_t last,
                                                  const RankLimits& limits) {
  found_.clear();
  for (std::uint32_t v = first; v < last; ++v) {
    for_edges_at(v, [&](std::uint32_t a, std::uint32_t b) {
      const Costs cost = costs(a, b);
      if (!std::isfinite(cost.ranking)) return;
      const CostKey key = key_of(cost.ranking);
      if (key <= limits.key && cost.planes <= limits.max_cost) found_.push_back({a, b, key});
    });
  }
  sort_found();
  return sorted_;
}

void EdgeRanking::sort_found() {
  sorted_.resize(found_.size());
  if (found_.empty()) return;
  const auto [low, high] =
      std::minmax_element(found_.begin(), found_.end(),
                          [](const RankedEdge& x, const RankedEdge& y) { return x.key < y.key; });
  const std::uint32_t base = bucket_of(low->key);
  starts_.assign(bucket_of(high->key) - base + 2, 0);
  for (const RankedEdge& e : found_) ++starts_[bucket_of(e.key) - base + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  for (const RankedEdge& e : found_) sorted_[starts_[bucket_of(e.key) - base]++] = e;
}

}  // namespace meshfarm
