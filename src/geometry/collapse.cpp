// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/collapse.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/simplify_clean.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_none = UINT32_MAX;

// No vertex either; unlike k_none it is found in no ring.
constexpr std::uint32_t k_gap = UINT32_MAX - 1;
constexpr std::uint32_t k_compared_at_once = 8;

// The neighbour of an open ring that no triangle begins at.
template <typename Ring>
std::uint32_t last_neighbour(const Ring& ring) {
  const auto* const end = ring.next.data() + ring.size;
  for (std::uint32_t i = 0; i < ring.size; ++i) {
    if (ring.prev[i] == k_gap) continue;
    if (std::find(ring.next.data(), end, ring.prev[i]) == end) return ring.prev[i];
  }
  return k_none;
}

template <typename Ring>
std::uint32_t count_in(const Ring& ring, std::uint32_t vertex) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < ring.size; ++i) count += ring.next[i] == vertex ? 1 : 0;
  return count;
}

}  // namespace

void CollapseJudge::walk(const End& end, Ring& ring) {
  const std::span<const Corner> corners = state_.adjacency->at(end.vertex);
  const std::uint32_t* const target = state_.target.data();
  const Vec3* const positions = state_.positions.data();
  const auto size = static_cast<std::uint32_t>(corners.size());
  const Corner none{end.vertex, end.vertex};
  std::uint32_t triangles = 0;
  for (std::uint32_t i = 0; i < size; i += 2) {
    const Corner& c0 = corners[i];
    const Corner& c1 = i + 1 < size ? corners[i + 1] : none;
    const std::array<std::uint32_t, 2> next{target[c0.next], target[c1.next]};
    const std::array<std::uint32_t, 2> prev{target[c0.prev], target[c1.prev]};
    CollapseStar::Mask there{};
    CollapseStar::Mask shared{};
    for (std::uint32_t l = 0; l < 2; ++l) {
      // Equal after another collapse of this pass: the triangle is gone.
      const bool gone = next[l] == prev[l];
      there[l] = -static_cast<std::int64_t>(!gone);
      shared[l] = -static_cast<std::int64_t>(next[l] == end.other) |
                  -static_cast<std::int64_t>(prev[l] == end.other);
      ring.next[i + l] = gone ? k_gap : next[l];
      ring.prev[i + l] = gone ? k_gap : prev[l];
      triangles += gone ? 0 : 1;
    }
    star_.add({positions[next[0]], positions[prev[0]], positions[next[1]], positions[prev[1]],
               there & (~shared | end.counts_shared), there & ~shared},
              end.from_middle);
  }
  ring.size = size + size % 2;
  ring.triangles = triangles;
  ring.border = (state_.flags[end.vertex] & k_border) != 0;
}

std::uint32_t CollapseJudge::shared_triangles(std::uint32_t b) const {
  std::uint32_t shared = 0;
  const std::uint32_t size = ring_a_.size;
  for (std::uint32_t i = 0; i < size; ++i) {
    shared += (ring_a_.next[i] == b ? 1 : 0) + (ring_a_.prev[i] == b ? 1 : 0);
  }
  return shared;
}

std::uint32_t CollapseJudge::common_neighbours() const {
  std::array<std::uint32_t, k_compared_at_once> equal{};
  for (std::uint32_t i = 0; i < ring_b_.size; ++i) {
    const std::uint32_t vertex = ring_b_.next[i] == k_gap ? k_none : ring_b_.next[i];
    for (std::uint32_t first = 0; first < ring_a_.size; first += k_compared_at_once) {
      const std::uint32_t* const next = ring_a_.next.data() + first;
      for (std::uint32_t l = 0; l < k_compared_at_once; ++l) equal[l] += next[l] == vertex ? 1 : 0;
    }
  }
  std::uint32_t common = std::accumulate(equal.begin(), equal.end(), 0U);
  if (!ring_a_.border && !ring_b_.border) return common;
  const std::uint32_t last_a = ring_a_.border ? last_neighbour(ring_a_) : k_none;
  const std::uint32_t last_b = ring_b_.border ? last_neighbour(ring_b_) : k_none;
  if (last_a != k_none) common += count_in(ring_b_, last_a);
  if (last_b != k_none) common += count_in(ring_a_, last_b);
  return common + (last_a != k_none && last_a == last_b ? 1 : 0);
}

/// The link condition (Dey, Edelsbrunner, Guha, Nekhayev 1999), with all borders joined to one
/// vertex at infinity. It also keeps two triangles from becoming one.
bool CollapseJudge::link_allows(std::uint32_t shared) const {
  if (shared == 2) {
    if (ring_a_.border && ring_b_.border) return false;
    if (ring_a_.triangles == 3 && ring_b_.triangles == 3) return false;
  } else {
    if (shared != 1 || (ring_a_.triangles == 1 && ring_b_.triangles == 1)) return false;
  }
  return common_neighbours() == shared;
}

void CollapseJudge::add_border(const Ring& ring, Vec3 end, std::uint32_t without) {
  std::array<Corner, k_max_star> fan;
  std::uint32_t size = 0;
  for (std::uint32_t i = 0; i < ring.size; ++i) {
    if (ring.next[i] != k_gap) fan[size++] = {ring.next[i], ring.prev[i]};
  }
  const Vec3 at = middle_ + end;
  for_border_edges({fan.data(), size}, [&](const Corner& c, std::uint32_t neighbour) {
    if (neighbour == without) return;
    Quadric plane;
    add_border_plane(plane, cross(state_.positions[c.next] - at, state_.positions[c.prev] - at),
                     state_.positions[neighbour] - at);
    quadric_.add(plane, end);
  });
}

/// An inner vertex that merges into a border leaves the border as it is.
Vec3 CollapseJudge::best_position(std::uint32_t a, std::uint32_t b) const {
  if (ring_a_.border == ring_b_.border) return rounded(middle_ + quadric_.best(), state_.type);
  return rounded(state_.positions[ring_a_.border ? a : b], state_.type);
}

Collapse CollapseJudge::judge(std::uint32_t a, std::uint32_t b, const CollapseLimits& limits) {
  if (state_.adjacency->count(a) + state_.adjacency->count(b) > k_max_star) return {};
  const Vec3 half = (state_.positions[b] - state_.positions[a]) * 0.5;
  middle_ = state_.positions[a] + half;
  star_.clear(middle_, half);
  walk({a, b, half * -1.0, CollapseStar::Mask{-1, -1}}, ring_a_);
  // The ring that is searched may be compared beyond its end.
  std::fill_n(ring_a_.next.begin() + ring_a_.size, k_compared_at_once, k_gap);
  walk({b, a, half, CollapseStar::Mask{}}, ring_b_);
  const std::uint32_t shared = shared_triangles(b);
  if (shared > limits.triangles || !link_allows(shared)) return {};

  quadric_ = {};
  quadric_.squared_length = 4 * squared_length(half);
  star_.sum_planes(quadric_);
  if (ring_a_.border) add_border(ring_a_, half * -1.0, k_none);
  if (ring_b_.border) add_border(ring_b_, half, a);

  const Vec3 position = best_position(a, b);
  const Vec3 x = position - middle_;
  double cost = quadric_.cost(x);
  if (!(cost <= limits.max_cost)) return {};
  const std::optional<double> lost = star_.lost_area(x);
  if (!lost) return {};
  cost = std::max(cost, quadric_.cost_of_lost_area(*lost));
  return cost <= limits.max_cost ? Collapse{shared, position, cost} : Collapse{};
}

}  // namespace meshfarm
