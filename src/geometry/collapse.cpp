// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/collapse.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/simplify_clean.hpp"

namespace meshfarm {
namespace {

constexpr double k_cos_75_squared = 0.066987298107780676;
// Of the angle at the new vertex: near 0 and near 180 degrees alike are as good as no area.
constexpr double k_least_sine_squared = 1e-6;

constexpr std::uint32_t k_none = UINT32_MAX;

// The neighbour of an open ring that no triangle begins at.
template <typename Ring>
std::uint32_t last_neighbour(const Ring& ring) {
  for (std::uint32_t i = 0; i < ring.size; ++i) {
    const auto* const end = ring.next.data() + ring.size;
    if (std::find(ring.next.data(), end, ring.prev[i]) == end) return ring.prev[i];
  }
  return k_none;
}

}  // namespace

void CollapseJudge::walk_ring(std::uint32_t vertex, Ring& ring) const {
  ring.size = 0;
  for (const Corner& c : state_.adjacency->at(vertex)) {
    const std::uint32_t next = state_.target[c.next];
    const std::uint32_t prev = state_.target[c.prev];
    ring.next[ring.size] = next;
    ring.prev[ring.size] = prev;
    // Equal after another collapse of this pass: the triangle is gone.
    ring.size += next != prev ? 1 : 0;
  }
  ring.border = (state_.flags[vertex] & k_border) != 0;
}

std::uint32_t CollapseJudge::shared_triangles(std::uint32_t b) const {
  std::uint32_t shared = 0;
  for (std::uint32_t i = 0; i < ring_a_.size; ++i) {
    shared += (ring_a_.next[i] == b ? 1 : 0) + (ring_a_.prev[i] == b ? 1 : 0);
  }
  return shared;
}

std::uint32_t CollapseJudge::common_neighbours() const {
  std::uint32_t common = 0;
  const auto count = [&](const Ring& ring, std::uint32_t vertex) {
    for (std::uint32_t i = 0; i < ring.size; ++i) common += ring.next[i] == vertex ? 1 : 0;
  };
  for (std::uint32_t i = 0; i < ring_a_.size; ++i) count(ring_b_, ring_a_.next[i]);
  const std::uint32_t last_a = ring_a_.border ? last_neighbour(ring_a_) : k_none;
  const std::uint32_t last_b = ring_b_.border ? last_neighbour(ring_b_) : k_none;
  if (last_a != k_none) count(ring_b_, last_a);
  if (last_b != k_none) count(ring_a_, last_b);
  return common + (last_a != k_none && last_a == last_b ? 1 : 0);
}

/// The link condition (Dey, Edelsbrunner, Guha, Nekhayev 1999), with all borders joined to one
/// vertex at infinity. It also keeps two triangles from becoming one.
bool CollapseJudge::link_allows(std::uint32_t shared) const {
  if (shared == 2) {
    if (ring_a_.border && ring_b_.border) return false;
    if (ring_a_.size == 3 && ring_b_.size == 3) return false;
  } else {
    if (shared != 1 || (ring_a_.size == 1 && ring_b_.size == 1)) return false;
  }
  return common_neighbours() == shared;
}

void CollapseJudge::add_star(const Ring& ring, std::uint32_t other, bool with_shared) {
  for (std::uint32_t i = 0; i < ring.size; ++i) {
    const bool shared = ring.next[i] == other || ring.prev[i] == other;
    if (shared && !with_shared) continue;
    StarTriangle& t = star_[star_size_];
    t.p = state_.positions[ring.next[i]] - middle_;
    t.q = state_.positions[ring.prev[i]] - middle_;
    t.apex = ring.apex;
    t.normal = cross(t.p - t.apex, t.q - t.apex);
    star_size_ += shared ? 0 : 1;
    const double twice_area = length(t.normal);
    if (!(twice_area > 0 && std::isfinite(twice_area))) continue;
    area_ += 0.5 * twice_area;
    const double weight = 0.5 / twice_area;
    const double height = dot(t.normal, t.apex);
    quadric_.a.add(t.normal, weight);
    quadric_.b = quadric_.b + t.normal * (weight * height);
    quadric_.c += weight * height * height;
  }
}

void CollapseJudge::add_border(const Ring& ring, std::uint32_t without) {
  std::array<Corner, k_max_star> fan;
  for (std::uint32_t i = 0; i < ring.size; ++i) fan[i] = {ring.next[i], ring.prev[i]};
  const Vec3 apex = middle_ + ring.apex;
  for_border_edges({fan.data(), ring.size}, [&](const Corner& c, std::uint32_t end) {
    if (end == without) return;
    Quadric plane;
    add_border_plane(plane, cross(state_.positions[c.next] - apex, state_.positions[c.prev] - apex),
                     state_.positions[end] - apex);
    quadric_.add(plane, ring.apex);
  });
}

/// Adds the area that the triangle has with its apex at x; false if that spoils its shape.
bool CollapseJudge::add_kept_area(const StarTriangle& t, Vec3 x, double& area) {
  const Vec3 p = t.p - x;
  const Vec3 q = t.q - x;
  const Vec3 normal = cross(p, q);
  const double size = squared_length(normal);
  const double old_size = squared_length(t.normal);
  const double turn = dot(normal, t.normal);
  const bool turned = !(turn > 0 && turn * turn >= k_cos_75_squared * size * old_size);
  if (turned && old_size > 0) return false;
  area += 0.5 * std::sqrt(size);
  const double scale = squared_length(p) * squared_length(q);
  if (size > k_least_sine_squared * scale) return true;
  // A sliver of the input may stay one, or nothing round it could ever collapse.
  const double old_scale = squared_length(t.p - t.apex) * squared_length(t.q - t.apex);
  return old_size <= k_least_sine_squared * old_scale && size * old_scale >= old_size * scale &&
         (size > 0 || old_size == 0);
}

/// An inner vertex that merges into a border leaves the border as it is.
Vec3 CollapseJudge::best_position(std::uint32_t a, std::uint32_t b) const {
  if (ring_a_.border == ring_b_.border) return rounded(middle_ + quadric_.best(), state_.type);
  return rounded(state_.positions[ring_a_.border ? a : b], state_.type);
}

Collapse CollapseJudge::judge(std::uint32_t a, std::uint32_t b, const CollapseLimits& limits) {
  if (state_.adjacency->count(a) + state_.adjacency->count(b) > k_max_star) return {};
  walk_ring(a, ring_a_);
  walk_ring(b, ring_b_);
  const std::uint32_t shared = shared_triangles(b);
  if (shared > limits.triangles || !link_allows(shared)) return {};

  const Vec3 half = (state_.positions[b] - state_.positions[a]) * 0.5;
  middle_ = state_.positions[a] + half;
  ring_a_.apex = half * -1.0;
  ring_b_.apex = half;
  quadric_ = {};
  quadric_.squared_length = 4 * squared_length(half);
  star_size_ = 0;
  area_ = 0;
  add_star(ring_a_, b, true);
  add_star(ring_b_, a, false);
  if (ring_a_.border) add_border(ring_a_, k_none);
  if (ring_b_.border) add_border(ring_b_, a);

  const Vec3 position = best_position(a, b);
  const Vec3 x = position - middle_;
  double cost = quadric_.cost(x);
  if (!(cost <= limits.max_cost)) return {};
  double kept = 0;
  for (std::uint32_t i = 0; i < star_size_; ++i) {
    if (!add_kept_area(star_[i], x, kept)) return {};
  }
  cost = std::max(cost, quadric_.cost_of_lost_area(area_ - kept));
  return cost <= limits.max_cost ? Collapse{shared, position, cost} : Collapse{};
}

}  // namespace meshfarm
