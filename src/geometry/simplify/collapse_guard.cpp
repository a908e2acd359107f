// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/collapse_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "geometry/distance_across.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_points_at_once = 4096;
/// A triangle nearer than this share of the bound is as good as any other.
constexpr double k_near_share = 0.5;
/// The same at the start, where the triangles are small.
constexpr double k_start_share = 0.25;
/// Spacing of the points checked on a side of the surface, in units of the bound, and the maximum
/// number of steps.
constexpr double k_side_spacing = 0.75;
constexpr double k_most_on_side = 32;
constexpr std::size_t k_memo = 1U << 18;

}  // namespace

/// The owner is the nearest of the triangle's corners.
CollapseGuard::Place CollapseGuard::place_on(std::uint32_t point, const Triangle& triangle) const {
  const Vec3 p = held_[point].point;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t v = triangle[i];
    const bool moves = v == merge_.a && merge_.a != merge_.b;
    const double squared = squared_length(p - (moves ? merge_.position : state_.positions[v]));
    if (squared < least) {
      least = squared;
      best = i;
    }
  }
  return {point,      triangle[best], triangle[(best + 1) % 3], triangle[(best + 2) % 3],
          k_no_point, k_no_point};
}

void CollapseGuard::hold(std::uint32_t point, const Triangle& triangle) {
  const Place place = place_on(point, triangle);
  Held& held = held_[point];
  held.owner = place.owner;
  held.next = place.next;
  held.prev = place.prev;
  held.following = std::exchange(bag_[place.owner], point);
}

void CollapseGuard::start(const CollapseState& state, const Mesh& mesh) {
  move_to(state);
  merge_ = {};
  bag_.assign(mesh.positions.size(), k_no_point);
  moves_.assign(mesh.positions.size(), 0);
  has_failed_.assign(mesh.positions.size(), 0);
  memo_.assign(k_memo, 0);
  held_.clear();
  if (mesh.triangles.empty()) return;
  const std::span<const SurfacePoint> points = bound_.points();
  const Bvh bvh(mesh, bound_.options().threads);
  std::vector<Bvh::Nearest> nearest(points.size());
  const double most = bound_.distance() * bound_.distance();
  const double enough = most * k_start_share * k_start_share;
  const auto chunks = (points.size() + k_points_at_once - 1) / k_points_at_once;
  parallel_for(chunks, bound_.options().threads, [&](std::uint64_t chunk) {
    std::uint32_t guess = 0;
    const std::size_t end = std::min(points.size(), (chunk + 1) * k_points_at_once);
    for (std::size_t i = chunk * k_points_at_once; i < end; ++i) {
      nearest[i] = bvh.nearest(points[i].at, guess, enough);
      guess = nearest[i].triangle;
    }
  });
  held_of_.assign(points.size(), k_no_point);
  const auto is_fixed = [&](std::uint32_t v) { return (state_.flags[v] & k_fixed) != 0; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Triangle& t = mesh.triangles[nearest[i].triangle];
    if (std::all_of(t.begin(), t.end(), is_fixed)) continue;
    const auto limit = static_cast<float>(std::max(most, nearest[i].squared) * (1 + 0x1p-20));
    held_of_[i] = static_cast<std::uint32_t>(held_.size());
    const SurfacePoint& from = points[i];
    held_.push_back({from.at, limit, from.share, from.triangle, k_no_point, 0, 0, 0,
                     static_cast<std::uint32_t>(i), from.is_dense});
    hold(static_cast<std::uint32_t>(held_.size() - 1), t);
  }
  place_of_.assign(held_.size(), 0);
}

void CollapseGuard::list_star(const Merge& merge) {
  star_.clear();
  ring_.clear();
  const auto vanishes = [&](const Corner& c) {
    return std::any_of(merge.vanishing.begin(), merge.vanishing.end(), [&](const auto& pair) {
      return (pair.first == c.next && pair.second == c.prev) ||
             (pair.first == c.prev && pair.second == c.next);
    });
  };
  for (const std::uint32_t end : {merge.a, merge.b}) {
    const std::uint32_t other = end == merge.a ? merge.b : merge.a;
    for (const Corner& c : state_.adjacency->at(end)) {
      for (const std::uint32_t v : {c.next, c.prev}) {
        if (v != other) ring_.push_back(v);
      }
      if (c.next != other && c.prev != other && !vanishes(c)) star_.push_back(c);
    }
  }
  std::sort(ring_.begin(), ring_.end());
  ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
}

bool CollapseGuard::allows(const Merge& merge) {
  merge_ = merge;
  places_.clear();
  const std::uint32_t key = signature();
  if (memo() == key) return false;
  list_star(merge);
  on_facet_.assign(star_.size(), k_no_point);
  if (!star_.empty() && probe_.is_near(merge_.position) && place_all() && are_sides_near() &&
      is_star_near()) {
    return true;
  }
  memo() = key;
  return false;
}

/// A hash of the edge and of how often its ends have moved; never 0.
std::uint32_t CollapseGuard::signature() const {
  std::uint64_t h = (std::uint64_t{merge_.a} << 32 | merge_.b) * 0x9e3779b97f4a7c15U;
  h ^= h >> 29;
  h += std::uint64_t{moves_[merge_.a]} << 32 | moves_[merge_.b];
  h *= 0xbf58476d1ce4e5b9U;
  return static_cast<std::uint32_t>(h >> 32) | 1U;
}

std::uint32_t& CollapseGuard::memo() {
  const std::uint64_t h = (std::uint64_t{merge_.a} << 32 | merge_.b) * 0x94d049bb133111ebU;
  return memo_[(h >> 40) % k_memo];
}

/// For a point held by a vertex other than the ends: whether its triangle is one of theirs, or
/// unknown.
bool CollapseGuard::is_changed(const Held& held) const {
  return held.next == held.prev || is_end(held.next) || is_end(held.prev);
}

/// Points that failed before often fail again, so they are tried first.
bool CollapseGuard::fails_again(std::uint32_t vertex) {
  const std::uint32_t first = bag_[vertex];
  if (has_failed_[vertex] == 0 || first == k_no_point) return false;
  if (!is_end(vertex) && !is_changed(held_[first])) return false;
  const bool is_placed = place(vertex, first);
  places_.clear();
  on_facet_.assign(star_.size(), k_no_point);
  return !is_placed;
}

bool CollapseGuard::place_all() {
  if (fails_again(merge_.a) || fails_again(merge_.b)) return false;
  if (std::any_of(ring_.begin(), ring_.end(), [&](std::uint32_t v) { return fails_again(v); })) {
    return false;
  }
  if (!place_bag(merge_.a, true) || !place_bag(merge_.b, true)) return false;
  return std::all_of(ring_.begin(), ring_.end(),
                     [&](std::uint32_t v) { return place_bag(v, false); });
}

bool CollapseGuard::place_bag(std::uint32_t vertex, bool all) {
  std::uint32_t before = k_no_point;
  for (std::uint32_t i = bag_[vertex]; i != k_no_point; i = held_[i].following) {
    if ((all || is_changed(held_[i])) && !place(vertex, i)) {
      to_front(vertex, before, i);
      return false;
    }
    before = i;
  }
  return true;
}

/// Moves a point that was too far to the front, to be tried first.
void CollapseGuard::to_front(std::uint32_t vertex, std::uint32_t before, std::uint32_t point) {
  has_failed_[vertex] = 1;
  if (before == k_no_point) return;
  held_[before].following = held_[point].following;
  held_[point].following = std::exchange(bag_[vertex], point);
}

/// The index in the star of the triangle that a point was near, or 0.
std::size_t CollapseGuard::facet_of(std::uint32_t owner, const Held& held) const {
  Corner corner{held.next, held.prev};
  if (is_end(held.next)) corner = {held.prev, owner};
  if (is_end(held.prev)) corner = {owner, held.next};
  const auto found = std::find(star_.begin(), star_.end(), corner);
  return found == star_.end() ? 0 : static_cast<std::size_t>(found - star_.begin());
}

/// Searches until a triangle is near enough, or is right below the point and at most `most` away.
void CollapseGuard::look_at_star(Vec3 point, std::size_t first, double enough, double most,
                                 Nearest& nearest) const {
  for (std::size_t i = 0; i < star_.size() && nearest.squared > enough; ++i) {
    const std::size_t facet = first + i < star_.size() ? first + i : first + i - star_.size();
    const auto& [next, prev] = star_[facet];
    const DistanceAcross here =
        distance_across(point, merge_.position, state_.positions[next], state_.positions[prev]);
    if (!(here.squared < nearest.squared)) continue;
    nearest = {here.squared, {merge_.a, next, prev}, static_cast<std::uint32_t>(facet)};
    if (here.is_inside() && here.squared <= most) return;
  }
}

/// Searches the triangles at a vertex of the ring, except those at the ends.
void CollapseGuard::look_round(std::uint32_t around, Vec3 point, Nearest& nearest) const {
  for (const auto& [next, prev] : state_.adjacency->at(around)) {
    if (is_end(next) || is_end(prev)) continue;
    const double squared = squared_distance(point, state_.positions[around], state_.positions[next],
                                            state_.positions[prev]);
    if (squared < nearest.squared) nearest = {squared, {around, next, prev}, k_no_point};
  }
}

void CollapseGuard::look_round_star(Vec3 point, Nearest& nearest) const {
  look_round(nearest_of_ring(point), point, nearest);
}

bool CollapseGuard::place(std::uint32_t owner, std::uint32_t point) {
  const Held& held = held_[point];
  const double most = held.limit;
  const double enough = bound_.distance() * bound_.distance() * k_near_share * k_near_share;
  Nearest nearest;
  const std::size_t first = facet_of(owner, held);
  look_at_star(held.point, first, enough, most, nearest);
  if (nearest.squared > most) look_round_star(held.point, nearest);
  if (!(nearest.squared <= most)) return false;
  if (nearest.squared > enough && held.share != 0 && !is_cell_near(held, first)) return false;
  Place& placed = places_.emplace_back(place_on(point, nearest.triangle));
  placed.facet = nearest.facet;
  place_of_[point] = static_cast<std::uint32_t>(places_.size() - 1);
  if (nearest.facet != k_no_point) {
    placed.following =
        std::exchange(on_facet_[nearest.facet], static_cast<std::uint32_t>(places_.size() - 1));
  }
  return true;
}

double CollapseGuard::squared_to(Vec3 point, const Triangle& triangle) const {
  const auto at = [&](std::uint32_t v) {
    return v == merge_.a ? merge_.position : state_.positions[v];
  };
  return squared_distance(point, at(triangle[0]), at(triangle[1]), at(triangle[2]));
}

/// A side of the surface is near as a whole if both of its ends are near the same triangle.
bool CollapseGuard::are_sides_near() {
  return std::all_of(places_.begin(), places_.end(), [&](const Place& place) {
    const auto across = bound_.across_sides(held_[place.point].number);
    return std::all_of(across.begin(), across.end(),
                       [&](std::uint32_t other) { return is_side_near(place, held_of_[other]); });
  });
}

bool CollapseGuard::is_side_near(const Place& place, std::uint32_t across) {
  if (across == k_no_point) return true;
  const std::uint32_t found = place_of_[across];
  const bool is_placed = found < places_.size() && places_[found].point == across;
  const Place* other = is_placed ? &places_[found] : nullptr;
  if (other != nullptr &&
      (across < place.point || (other->facet == place.facet && other->facet != k_no_point))) {
    return true;
  }
  const Held& from = held_[place.point];
  const Held& to = held_[across];
  if (other == nullptr && to.next == to.prev) return true;
  const Triangle at_end = other != nullptr ? Triangle{other->owner, other->next, other->prev}
                                           : Triangle{to.owner, to.next, to.prev};
  if (squared_to(to.point, {place.owner, place.next, place.prev}) <= to.limit) return true;
  if (squared_to(from.point, at_end) <= from.limit) return true;
  return is_side_near(from, to, at_end, place.facet == k_no_point ? 0 : place.facet);
}

/// If a point was not near the old star, the collapse changes nothing for it.
bool CollapseGuard::was_near_star(Vec3 point, double most) const {
  for (const std::uint32_t end : {merge_.a, merge_.b}) {
    for (const auto& [next, prev] : state_.adjacency->at(end)) {
      if (squared_distance(point, state_.positions[end], state_.positions[next],
                           state_.positions[prev]) <= most) {
        return true;
      }
    }
  }
  return false;
}

/// Checks points between the ends, if these are near different triangles.
bool CollapseGuard::is_side_near(const Held& from, const Held& to, const Triangle& at_end,
                                 std::size_t first) const {
  const double most = std::max(from.limit, to.limit);
  const Vec3 along = to.point - from.point;
  const double steps = std::clamp<double>(
      std::ceil(length(along) / (k_side_spacing * bound_.distance())), 2, k_most_on_side);
  for (double i = 1; i < steps; ++i) {
    const Vec3 point = from.point + along * (i / steps);
    if (squared_to(point, at_end) <= most) continue;
    Nearest nearest;
    look_at_star(point, first, most, most, nearest);
    if (nearest.squared > most) look_round_star(point, nearest);
    for (std::size_t k = 0; k < ring_.size() && nearest.squared > most; ++k) {
      look_round(ring_[k], point, nearest);
    }
    if (nearest.squared > most && was_near_star(point, most)) return false;
  }
  return true;
}

/// Checks the area that a point stands for; only needed where the point itself is not quite near.
bool CollapseGuard::is_cell_near(const Held& held, std::size_t first) const {
  constexpr double k_to_corner = 0.7;
  const Mesh& surface = bound_.surface();
  const auto& [a, b, c] = surface.triangles[held.source];
  const Vec3 middle =
      (surface.positions[a] + surface.positions[b] + surface.positions[c]) * (1.0 / 3);
  return std::all_of(surface.triangles[held.source].begin(), surface.triangles[held.source].end(),
                     [&](std::uint32_t v) {
                       const Vec3 point = held.point + (surface.positions[v] - middle) *
                                                           (k_to_corner * held.share);
                       Nearest nearest;
                       look_at_star(point, first, held.limit, held.limit, nearest);
                       if (nearest.squared > held.limit) look_round_star(point, nearest);
                       return nearest.squared <= held.limit;
                     });
}

/// Points that are not near the star may be near the triangles around it.
std::uint32_t CollapseGuard::nearest_of_ring(Vec3 point) const {
  return *std::min_element(ring_.begin(), ring_.end(), [&](std::uint32_t x, std::uint32_t y) {
    return squared_length(state_.positions[x] - point) <
           squared_length(state_.positions[y] - point);
  });
}

/// Checks the new triangles only: the sides of the ring were there before, and the merged vertex is
/// known to be near.
bool CollapseGuard::is_star_near() {
  for (const std::uint32_t v : ring_) {
    if (!probe_.is_side_near(merge_.position, state_.positions[v])) return false;
  }
  for (std::size_t facet = 0; facet < star_.size(); ++facet) {
    feet_.clear();
    for (std::uint32_t i = on_facet_[facet]; i != k_no_point; i = places_[i].following) {
      const Held& held = held_[places_[i].point];
      if (held.is_dense) feet_.push_back(held.point);
    }
    const auto& [next, prev] = star_[facet];
    if (!probe_.is_inside_near({merge_.position, state_.positions[next], state_.positions[prev]},
                               feet_)) {
      return false;
    }
  }
  return true;
}

void CollapseGuard::merge() {
  const auto [a, b] = std::pair(merge_.a, merge_.b);
  ++moves_[a];
  bag_[a] = bag_[b] = k_no_point;
  for (const std::uint32_t v : ring_) {
    for (std::uint32_t* at = &bag_[v]; *at != k_no_point;) {
      Held& held = held_[*at];
      is_changed(held) ? * at = held.following : *(at = &held.following);
    }
  }
  for (const Place& place : places_) {
    Held& held = held_[place.point];
    held.owner = place.owner;
    held.next = place.next;
    held.prev = place.prev;
    held.following = std::exchange(bag_[place.owner], place.point);
  }
}

}  // namespace meshfarm
