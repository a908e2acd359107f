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
constexpr std::uint64_t k_least_sample = 2000;

constexpr std::size_t k_listed_at_once = 1024;

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
    for (const std::uint32_t v : t) quadrics_[v].add(plane);
  }
}

void EdgeRanking::sum_border_planes() {
  for (std::uint32_t v = 0; v < input_.flags.size(); ++v) {
    if ((input_.flags[v] & (k_border | k_fixed)) != k_border) continue;
    if (input_.adjacency->count(v) > k_max_star) continue;
    const Vec3 at = input_.positions[v];
    for_border_edges(input_.adjacency->at(v), [&](const Corner& c, std::uint32_t end) {
      const Vec3 normal = cross(input_.positions[c.next] - at, input_.positions[c.prev] - at);
      Quadric plane;
      add_border_plane(plane, normal, input_.positions[end] - at);
      quadrics_[v].add(plane);
    });
  }
}

/// Lists the edges that may collapse of which the vertex is the smaller end.
inline void EdgeRanking::list_edges_at(std::uint32_t vertex) {
  const std::uint8_t flags = input_.flags[vertex];
  const std::span<const Corner> fan = input_.adjacency->at(vertex);
  if ((flags & k_fixed) != 0 || fan.size() > k_max_star) return;
  // Written always, counted if wanted: which neighbours are the greater ones no processor guesses.
  const std::size_t most = listed_count_ + fan.size() + 2;
  if (listed_.size() < most) listed_.resize(2 * most);
  const bool any_seam = !input_.seam_only || (flags & k_seam) != 0;
  const auto consider = [&](std::uint32_t end, std::uint8_t barred) {
    const std::uint8_t other = input_.flags[end];
    listed_[listed_count_] = {vertex, end};
    const bool wanted =
        (end > vertex) & ((other & (k_fixed | barred)) == 0) & (any_seam | ((other & k_seam) != 0));
    listed_count_ += wanted ? 1 : 0;
  };
  // An inner edge between two borders may not collapse: it would pinch the surface.
  const bool border = (flags & k_border) != 0;
  for (const Corner& c : fan) consider(c.next, border ? k_border : 0);
  if (border) {
    for_border_edges(fan, [&](const Corner&, std::uint32_t end) { consider(end, 0); });
  }
}

/// Calls take(edge, cost) for the edges, with finite cost, of one in so many of the vertices.
template <typename Take>
void EdgeRanking::for_costs(const Range& range, const Take& take) {
  for (std::uint32_t v = range.first; v < range.last; ++v) {
    if (scrambled(v) > UINT32_MAX / range.one_in) continue;
    list_edges_at(v);
    if (listed_count_ >= k_listed_at_once) cost_listed(take);
  }
  cost_listed(take);
}

template <typename Take>
void EdgeRanking::cost_listed(const Take& take) {
  const auto give = [&](const Edge& e, const EdgeCost& cost) {
    if (std::isfinite(cost.ranking)) take(e, cost);
  };
  for (std::size_t first = 0; first < listed_count_; first += EdgeCosts::k_size) {
    const std::size_t count = std::min(EdgeCosts::k_size, listed_count_ - first);
    for (std::size_t i = 0; i < count; ++i) {
      const auto [a, b] = listed_[first + i];
      costs_.put(i, quadrics_[a], quadrics_[b], (input_.positions[b] - input_.positions[a]) * 0.5);
    }
    costs_.compute();
    for (std::size_t i = 0; i < count; ++i) {
      const Edge& e = listed_[first + i];
      const std::uint8_t one_border = (input_.flags[e.a] ^ input_.flags[e.b]) & k_border;
      give(e, one_border == 0 ? costs_.get(i) : cost_of_border_end(e));
    }
  }
  listed_count_ = 0;
}

/// An inner vertex that merges into a border takes the border's position.
EdgeCost EdgeRanking::cost_of_border_end(const Edge& e) const {
  const bool border_a = (input_.flags[e.a] & k_border) != 0;
  return cost_of_end(quadrics_[border_a ? e.b : e.a],
                     (input_.positions[e.b] - input_.positions[e.a]) * 0.5);
}

/// Counts the keys of the edges of one in so many vertices into starts_.
std::uint64_t EdgeRanking::sample_costs(std::uint32_t one_in) {
  starts_.assign(bucket_of(k_any_cost) + 1, 0);
  std::uint64_t sampled = 0;
  const auto vertices = static_cast<std::uint32_t>(input_.positions.size());
  for_costs({0, vertices, one_in}, [&](const Edge&, const EdgeCost& cost) {
    ++starts_[bucket_of(key_of(cost.ranking))];
    ++sampled;
  });
  return sampled;
}

CostKey EdgeRanking::estimate_limit(double share, double most) {
  const auto vertices = static_cast<std::uint32_t>(input_.positions.size());
  std::uint32_t one_in = std::max(1U, vertices / k_sampled_vertices);
  std::uint64_t sampled = sample_costs(one_in);
  // Where most vertices are locked or no seam, a sample may say too little.
  if (sampled < k_least_sample && one_in > 1) {
    one_in = 1;
    sampled = sample_costs(one_in);
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
  for_costs({first, last, 1}, [&](const Edge& e, const EdgeCost& cost) {
    const CostKey key = key_of(cost.ranking);
    if (key <= limits.key && cost.least <= limits.max_cost) found_.push_back({e.a, e.b, key});
  });
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
