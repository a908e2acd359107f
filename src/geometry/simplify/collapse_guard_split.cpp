// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <limits>
#include <utility>

#include "geometry/bvh.hpp"
#include "geometry/simplify/collapse_guard.hpp"

namespace meshfarm {

void CollapseGuard::split(std::uint32_t vertex, std::uint32_t first_copy) {
  const auto copies = static_cast<std::uint32_t>(state_.positions.size());
  bag_.resize(copies, k_no_point);
  moves_.resize(copies, 0);
  has_failed_.resize(copies, 0);
  if (first_copy == copies) return;
  merge_ = {};
  for (std::uint32_t point = std::exchange(bag_[vertex], k_no_point); point != k_no_point;) {
    const std::uint32_t following = held_[point].following;
    hold(point, nearest_of_copies(held_[point].point, vertex, first_copy));
    point = following;
  }
  for (std::uint32_t v = first_copy; v < copies; ++v) {
    for (const Corner& c : state_.adjacency->at(v)) {
      forget_triangles(c.next, vertex);
      forget_triangles(c.prev, vertex);
    }
  }
}

/// The triangle nearest to a point, of those at a vertex and its copies from `first_copy` on.
Triangle CollapseGuard::nearest_of_copies(Vec3 point, std::uint32_t vertex,
                                          std::uint32_t first_copy) const {
  double best = std::numeric_limits<double>::infinity();
  Triangle nearest = {vertex, vertex, vertex};
  const auto look_at = [&](std::uint32_t v) {
    for (const Corner& c : state_.adjacency->at(v)) {
      const double squared = squared_distance(point, state_.positions[v], state_.positions[c.next],
                                              state_.positions[c.prev]);
      if (squared >= best) continue;
      best = squared;
      nearest = {v, c.next, c.prev};
    }
  };
  look_at(vertex);
  for (std::uint32_t v = first_copy; v < state_.positions.size(); ++v) look_at(v);
  return nearest;
}

/// Forgets the triangles of those points held by `owner` that are near a triangle of `vertex`.
void CollapseGuard::forget_triangles(std::uint32_t owner, std::uint32_t vertex) {
  for (std::uint32_t i = bag_[owner]; i != k_no_point; i = held_[i].following) {
    Held& held = held_[i];
    if (held.next == vertex || held.prev == vertex) held.next = held.prev = vertex;
  }
}

}  // namespace meshfarm
