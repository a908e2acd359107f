// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/crossing_guard.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/bvh_morton.hpp"
#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

/// Whether a normal is within an angle of a direction, given by the squared cosine.
bool is_along(Vec3 normal, Vec3 way, double cos_squared) {
  const double along = dot(normal, way);
  return along > 0 && along * along > cos_squared * squared_length(normal) * squared_length(way);
}

/// The direction that all triangles of a star face, if there is one: then no two of them cross.
std::optional<Vec3> way_of(const std::vector<CrossingTriangle>& star) {
  constexpr double k_least = 1e-9;
  Vec3 sum;
  for (const CrossingTriangle& t : star) sum = sum + t.normal;
  const bool faces_one_way = std::all_of(star.begin(), star.end(), [&](const CrossingTriangle& t) {
    return is_along(t.normal, sum, k_least);
  });
  return faces_one_way ? std::optional(sum) : std::nullopt;
}

}  // namespace

Box CrossingGuard::box_of(const Triangle& t) const {
  Box box;
  if (t[0] == t[1]) return box;
  for (const std::uint32_t v : t) {
    if (!is_finite(state_.positions[v])) return {};
    box.add(state_.positions[v]);
  }
  return box;
}

CrossingTriangle CrossingGuard::triangle_of(const Triangle& t) const {
  return CrossingTriangle({state_.positions[t[0]], state_.positions[t[1]], state_.positions[t[2]]});
}

/// The triangles with a vertex within two edges of a thin wall: all those at the ends of any edge
/// that has to be checked.
std::vector<Triangle> CrossingGuard::chosen(std::span<const Triangle> triangles) {
  levels_.assign(state_.positions.size(), 0);
  bool any = false;
  for (std::size_t v = 0; v < levels_.size(); ++v) {
    const bool is_thin = (state_.flags[v] & k_thin) != 0;
    any = any || is_thin;
    levels_[v] = is_thin ? 4 : 0;
  }
  std::vector<Triangle> chosen;
  if (!any) return chosen;
  for (const std::uint8_t level : {std::uint8_t{4}, std::uint8_t{3}, std::uint8_t{2}}) {
    const auto next = static_cast<std::uint8_t>(level - 1);
    for (const Triangle& t : triangles) {
      if (std::max({levels_[t[0]], levels_[t[1]], levels_[t[2]]}) < level) continue;
      for (const std::uint32_t v : t) levels_[v] = std::max(levels_[v], next);
      if (level == 2) chosen.push_back(t);
    }
  }
  return chosen;
}

void CrossingGuard::start(const CollapseState& state, std::span<const Triangle> all_triangles,
                          Where where) {
  state_ = state;
  levels_.clear();
  std::vector<Triangle> some;
  if (where == Where::thin_walls) some = chosen(all_triangles);
  const std::span<const Triangle> triangles = where == Where::thin_walls ? some : all_triangles;
  Box all;
  for (const Vec3& p : state.positions) {
    if (is_finite(p)) all.add(p);
  }
  BoxTree::Frame frame;
  if (!all.empty()) frame.center = all.lo * 0.5 + all.hi * 0.5;
  const double size = all.diagonal();
  if (size > 0 && std::isfinite(size)) frame.scale = std::ldexp(1.0, -std::ilogb(size) - 1);
  const auto corner_of = [&](std::uint32_t i) { return state.positions[triangles[i][0]]; };
  std::vector<MortonItem> items(triangles.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const Vec3 corner = corner_of(i);
    items[i].number = i;
    if (is_finite(corner)) items[i].code = morton_code((corner - frame.center) * frame.scale);
  }
  sort_along_curve(items, corner_of);
  triangles_.resize(items.size());
  std::vector<Box> boxes(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    triangles_[i] = triangles[items[i].number];
    boxes[i] = box_of(triangles_[i]);
  }
  boxes_.build(frame, boxes);
}

/// The box of everything that the merge changes, before and after it.
Box CrossingGuard::box_round(const Merge& merge) const {
  Box box;
  box.add(merge.position);
  for (const std::uint32_t end : {merge.a, merge.b}) {
    box.add(state_.positions[end]);
    for (const Corner& c : state_.adjacency->at(end)) {
      box.add(state_.positions[state_.target[c.next]]);
      box.add(state_.positions[state_.target[c.prev]]);
    }
  }
  return box;
}

/// Whether the triangle goes. Of two triangles that become equal and face the same way, that of a
/// stays.
bool CrossingGuard::vanishes(const Triangle& t) const {
  if (has_corner(t, merge_.a) && has_corner(t, merge_.b)) return true;
  if (merge_.vanishing.empty()) return false;
  const std::uint32_t end = has_corner(t, merge_.a) ? merge_.a : merge_.b;
  const auto [next, prev] = corner_at(t, end);
  const auto is_listed = [&](std::uint32_t first, std::uint32_t second) {
    return std::find(merge_.vanishing.begin(), merge_.vanishing.end(), std::pair(first, second)) !=
           merge_.vanishing.end();
  };
  return is_listed(next, prev) && (end == merge_.b || is_listed(prev, next));
}

void CrossingGuard::begin_list() {
  ++list_;
  listed_.resize(state_.positions.size(), 0);
}

void CrossingGuard::list(const Merge& merge) {
  merge_ = merge;
  touching_.clear();
  star_.clear();
  others_.clear();
  begin_list();
  boxes_.find_touching(box_round(merge), touching_);
  for (const std::uint32_t slot : touching_) {
    const Triangle& t = triangles_[slot];
    const bool is_star = has_corner(t, merge.a) || has_corner(t, merge.b);
    (is_star ? star_ : others_).push_back(slot);
    if (!is_star) continue;
    for (const std::uint32_t v : t) listed_[v] = list_;
  }
}

/// Counts the crossing pairs of a star's triangles, with each other and with those around them.
/// Stops at `enough`.
std::size_t CrossingGuard::count(const std::vector<CrossingTriangle>& star,
                                 std::size_t enough) const {
  std::size_t pairs = 0;
  const std::optional<Vec3> way = way_of(star);
  Box box;
  for (const CrossingTriangle& t : star) {
    box.add(t.box.lo);
    box.add(t.box.hi);
  }
  for (const std::uint32_t slot : others_) {
    const Triangle& t = triangles_[slot];
    if (way && goes_on(t, *way)) continue;
    const Box around = box_of(t);
    if (!do_touch(around, box)) continue;
    std::optional<CrossingTriangle> other;
    for (const CrossingTriangle& own : star) {
      if (!do_touch(own.box, around)) continue;
      if (!other) other = triangle_of(t);
      if (do_cross(own, *other) && ++pairs >= enough) return pairs;
    }
  }
  if (way) return pairs;
  for (std::size_t i = 0; i < star.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (do_cross(star[i], star[k]) && ++pairs >= enough) return pairs;
    }
  }
  return pairs;
}

/// Whether a triangle beside the star faces roughly the way that the star faces: then they do not
/// cross.
bool CrossingGuard::goes_on(const Triangle& t, Vec3 way) const {
  constexpr double k_cos_60_squared = 0.25;
  const bool is_beside =
      std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return listed_[v] == list_; });
  if (!is_beside) return false;
  const Vec3 p = state_.positions[t[0]];
  return is_along(cross(state_.positions[t[1]] - p, state_.positions[t[2]] - p), way,
                  k_cos_60_squared);
}

std::size_t CrossingGuard::count_before() const {
  std::vector<CrossingTriangle> star;
  for (const std::uint32_t slot : star_) star.push_back(triangle_of(triangles_[slot]));
  return count(star, SIZE_MAX);
}

bool CrossingGuard::crosses(const Merge& merge) {
  list(merge);
  fresh_.clear();
  for (const std::uint32_t slot : star_) {
    const Triangle& t = triangles_[slot];
    if (vanishes(t)) continue;
    TriangleCorners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = t[i] == merge.a || t[i] == merge.b ? merge.position : state_.positions[t[i]];
    }
    fresh_.emplace_back(corners);
  }
  if (!levels_.empty() && std::max(levels_[merge.a], levels_[merge.b]) < 3) return false;
  if (count(fresh_, 1) == 0) return false;
  const std::size_t before = count_before();
  return before == 0 || count(fresh_, before + 1) > before;
}

void CrossingGuard::merge() {
  std::size_t next = 0;
  for (const std::uint32_t slot : star_) {
    Triangle& t = triangles_[slot];
    if (vanishes(t)) {
      t = {};
      boxes_.set(slot, {});
      continue;
    }
    for (std::uint32_t& v : t) v = v == merge_.b ? merge_.a : v;
    boxes_.set(slot, fresh_[next++].box);
  }
}

bool CrossingGuard::moves(std::span<const std::uint32_t> vertices, std::span<const Vec3> places) {
  Box box;
  for (std::size_t i = 0; i < places.size(); ++i) {
    box.add(state_.positions[vertices[i]]);
    box.add(places[i]);
  }
  touching_.clear();
  star_.clear();
  others_.clear();
  begin_list();
  fresh_.clear();
  boxes_.find_touching(box, touching_);
  for (const std::uint32_t slot : touching_) {
    TriangleCorners corners{};
    std::size_t found = 0;
    for (const std::uint32_t v : triangles_[slot]) {
      const auto place = std::find(vertices.begin(), vertices.end(), v);
      if (place == vertices.end()) break;
      corners[found++] = places[static_cast<std::size_t>(place - vertices.begin())];
    }
    (found == 3 ? star_ : others_).push_back(slot);
    if (found == 3) fresh_.emplace_back(corners);
  }
  if (count(fresh_, 1) > 0 && count(fresh_, SIZE_MAX) > count_before()) return false;
  for (std::size_t i = 0; i < star_.size(); ++i) boxes_.set(star_[i], fresh_[i].box);
  return true;
}

void CrossingGuard::split(std::uint32_t vertex, std::uint32_t first_copy) {
  const auto copies = static_cast<std::uint32_t>(state_.positions.size());
  if (first_copy == copies) return;
  Box box;
  box.add(state_.positions[vertex]);
  touching_.clear();
  boxes_.find_touching(box, touching_);
  for (const std::uint32_t slot : touching_) {
    Triangle& t = triangles_[slot];
    const std::size_t at = place_of(t, vertex);
    if (at == t.size()) continue;
    const Corner corner = corner_at(t, vertex);
    for (std::uint32_t copy = first_copy; copy < copies; ++copy) {
      const std::span<const Corner> fan = state_.adjacency->at(copy);
      if (std::find(fan.begin(), fan.end(), corner) != fan.end()) t[at] = copy;
    }
  }
}

}  // namespace meshfarm
