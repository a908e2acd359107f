// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/collapse.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_none = UINT32_MAX;

constexpr std::uint32_t k_compared_at_once = 8;

// An end is preferred to the best point if it costs less than this share of its cost. With a share
// of 1, one triangle of a height field turned over, and a noisy town had 3 % more error.
constexpr double k_next_to_nothing = 0.01;

// Pairs of triangles around an edge.
constexpr std::uint32_t k_few_pairs = 3;

// The neighbour of an open ring that no triangle begins at.
template <typename Ring>
std::uint32_t last_neighbour(const Ring& ring) {
  const auto* const end = ring.next.data() + ring.size;
  for (std::uint32_t i = 0; i < ring.size; ++i) {
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

/// Lists the triangles at one end. Everything is written, but counted only if wanted: a branch on
/// which triangles are there would be mispredicted.
CollapseJudge::Walk CollapseJudge::walk(const Walk& walk, Ring& ring) const {
  const std::uint32_t* const target = state_.target.data();
  const std::uint32_t other = walk.other;
  Corner* shared_end = walk.shared;
  Corner* kept_end = walk.kept;
  std::uint32_t size = 0;
  for (const Corner& c : state_.adjacency->at(walk.vertex)) {
    const std::uint32_t next = target[c.next];
    const std::uint32_t prev = target[c.prev];
    ring.next[size] = next;
    ring.prev[size] = prev;
    // Equal after another collapse of this pass: the triangle is gone.
    const std::uint32_t there = next != prev ? 1 : 0;
    const std::uint32_t shared = ((next == other) | (prev == other)) ? 1 : 0;
    *shared_end = {next, prev};
    *kept_end = {next, prev};
    shared_end += there & shared;
    kept_end += there & ~shared;
    size += there;
  }
  ring.size = size;
  ring.flags = state_.flags[walk.vertex];
  return {walk.vertex, other, shared_end, kept_end};
}

/// Returns the number of shared triangles.
std::uint32_t CollapseJudge::list_star(std::uint32_t a, std::uint32_t b) {
  std::array<Corner, k_max_star> shared_again;
  std::array<Corner, k_max_star> shared_once;
  const Walk at_a = walk({a, b, shared_once.data(), corners_.data() + 2}, ring_a_);
  // Comparisons may read beyond the end of this ring.
  std::fill_n(ring_a_.next.begin() + ring_a_.size, k_compared_at_once, k_none);
  const Walk at_b = walk({b, a, shared_again.data(), at_a.kept}, ring_b_);
  *at_b.kept = {a, a};
  corners_[0] = shared_once[0];
  corners_[1] = shared_once[1];
  kept_of_a_ = static_cast<std::uint32_t>(at_a.kept - corners_.data()) - 2;
  kept_ = static_cast<std::uint32_t>(at_b.kept - corners_.data()) - 2;
  return static_cast<std::uint32_t>(at_a.shared - shared_once.data());
}

std::uint32_t CollapseJudge::common_neighbours() const {
  std::array<std::uint32_t, k_compared_at_once> equal{};
  for (std::uint32_t i = 0; i < ring_b_.size; ++i) {
    const std::uint32_t vertex = ring_b_.next[i];
    for (std::uint32_t first = 0; first < ring_a_.size; first += k_compared_at_once) {
      const std::uint32_t* const next = ring_a_.next.data() + first;
      for (std::uint32_t l = 0; l < k_compared_at_once; ++l) equal[l] += next[l] == vertex ? 1 : 0;
    }
  }
  std::uint32_t common = std::accumulate(equal.begin(), equal.end(), 0U);
  if (!ring_a_.border() && !ring_b_.border()) return common;
  const std::uint32_t last_a = ring_a_.border() ? last_neighbour(ring_a_) : k_none;
  const std::uint32_t last_b = ring_b_.border() ? last_neighbour(ring_b_) : k_none;
  if (last_a != k_none) common += count_in(ring_b_, last_a);
  if (last_b != k_none) common += count_in(ring_a_, last_b);
  return common + (last_a != k_none && last_a == last_b ? 1 : 0);
}

/// The link condition (Dey, Edelsbrunner, Guha, Nekhayev 1999), with all borders joined to one
/// vertex at infinity. It also keeps two triangles from becoming one.
bool CollapseJudge::link_allows(std::uint32_t shared) const {
  if (shared == 2) {
    if (ring_a_.border() && ring_b_.border()) return false;
    if (ring_a_.size == 3 && ring_b_.size == 3) return false;
  } else {
    if (shared != 1 || (ring_a_.size == 1 && ring_b_.size == 1)) return false;
  }
  return common_neighbours() == shared;
}

void CollapseJudge::add_star(std::uint32_t shared) {
  const Vec3* const positions = state_.positions.data();
  const auto add = [&](std::uint32_t i, CollapseStar::Pair sides) {
    const Corner& c0 = corners_[i];
    const Corner& c1 = corners_[i + 1];
    star_.add({positions[c0.next], positions[c0.prev], positions[c1.next], positions[c1.prev]},
              sides);
  };
  // Only one at a border.
  if (shared == 1) corners_[1] = {corners_[0].next, corners_[0].next};
  add(0, CollapseStar::Pair{-1, -1});
  for (std::uint32_t i = 0; i < kept_; i += 2) {
    add(i + 2, CollapseStar::Pair{i < kept_of_a_ ? -1.0 : 1.0, i + 1 < kept_of_a_ ? -1.0 : 1.0});
  }
}

/// Call after add_star(): places in the star are those in corners_.
void CollapseJudge::add_appearances(std::uint32_t a, std::uint32_t b, std::uint32_t shared) {
  if (state_.appearances.empty()) return;
  appearance_.clear(state_.appearance_scale);
  const auto add = [&](std::uint32_t place, std::uint32_t vertex) {
    const Corner& c = corners_[place];
    appearance_.add(star_.triangle(place), state_.values_at(vertex, c));
  };
  for (std::uint32_t i = 0; i < shared; ++i) add(i, a);
  for (std::uint32_t i = 0; i < kept_; ++i) add(i + 2, i < kept_of_a_ ? a : b);
  appearance_.add_to(quadric_);
}

/// The ids of the corners in the vertex's ring, in its order; empty if there are none.
std::span<const CornerId> CollapseJudge::ids_of(std::uint32_t vertex,
                                                std::span<CornerId> buffer) const {
  const CornerFan fan = state_.adjacency->fan_at(vertex);
  std::size_t size = 0;
  for (std::size_t i = 0; i < fan.ids.size(); ++i) {
    const Corner& c = fan.corners[i];
    if (state_.target[c.next] != state_.target[c.prev]) buffer[size++] = fan.ids[i];
  }
  return buffer.first(size);
}

/// for_crease_edges() at one end, as it is now.
template <typename Candidate, typename Take>
void CollapseJudge::for_creases_of(const Ring& ring, std::uint32_t vertex, Vec3 at,
                                   const Candidate& is_candidate, const Take& take) const {
  if ((ring.flags & k_crease) == 0) return;
  std::array<Corner, k_max_star> corners;
  for (std::uint32_t i = 0; i < ring.size; ++i) corners[i] = {ring.next[i], ring.prev[i]};
  std::array<CornerId, k_max_star> ids;
  for_crease_edges({std::span<const Corner>(corners.data(), ring.size), ids_of(vertex, ids),
                    state_.adjacency->fan_at(vertex).columns},
                   at, state_.positions, *state_.creases, is_candidate, take);
}

/// From the two border edges that leave the vertex at `at`; if there are more, the weight of a
/// corner.
double CollapseJudge::border_weight_at(std::span<const Corner> fan, Vec3 at) const {
  std::array<Vec3, 2> edges;
  std::size_t count = 0;
  for_border_edges(fan, [&](const Corner&, std::uint32_t neighbour) {
    if (count < edges.size()) edges[count] = state_.positions[neighbour] - at;
    ++count;
  });
  return count == edges.size() ? border_weight_between(edges[0], edges[1]) : 1;
}

/// Adds the planes of the lines at one end, except for the edge to `without`.
void CollapseJudge::add_lines(const Ring& ring, std::uint32_t vertex, Vec3 end,
                              std::uint32_t without) {
  const Vec3 at = middle_ + end;
  Quadric planes;
  const auto normal_of = [&](const Corner& c) {
    return cross(state_.positions[c.next] - at, state_.positions[c.prev] - at);
  };
  const auto add = [&](const Corner& c, std::uint32_t neighbour, double weight) {
    add_line_plane(planes, normal_of(c), state_.positions[neighbour] - at, weight);
  };
  if (ring.border()) {
    std::array<Corner, k_max_star> corners;
    for (std::uint32_t i = 0; i < ring.size; ++i) corners[i] = {ring.next[i], ring.prev[i]};
    const std::span<const Corner> fan(corners.data(), ring.size);
    const double weight = is_ribbon_ ? k_border_weight : border_weight_at(fan, at);
    for_border_edges(fan, [&](const Corner& c, std::uint32_t neighbour) {
      if (neighbour == without) return;
      const Vec3 edge = state_.positions[neighbour] - at;
      add(c, neighbour, weight * (is_ribbon_ ? weight_of_side(normal_of(c), edge) : 1));
    });
  }
  const auto is_other_on_crease = [&](std::uint32_t neighbour) {
    return neighbour != without && (state_.flags[neighbour] & k_crease) != 0;
  };
  for_creases_of(ring, vertex, at, is_other_on_crease,
                 [&](const Corner& one, const Corner& other, bool is_between_labels) {
                   add(one, one.prev, state_.creases->weight(is_between_labels));
                   add(other, one.prev, state_.creases->weight(is_between_labels));
                 });
  quadric_.add(planes, end);
}

/// The only neighbour along a crease other than `without`; k_none if there are none or several.
std::uint32_t CollapseJudge::next_on_line(const Ring& ring, std::uint32_t vertex,
                                          std::uint32_t without) const {
  std::uint32_t found = k_none;
  std::uint32_t count = 0;
  const auto is_other_on_crease = [&](std::uint32_t neighbour) {
    return neighbour != without && (state_.flags[neighbour] & k_crease) != 0;
  };
  for_creases_of(ring, vertex, state_.positions[vertex], is_other_on_crease,
                 [&](const Corner& one, const Corner&, bool) {
                   found = one.prev;
                   ++count;
                 });
  return count == 1 ? found : k_none;
}

/// Moves x so that the areas on both sides of a line between labels stay the same, seen along the
/// mean normal: planes alone let all curves bulge. This saves 4 % of the lines' error on a dragon
/// at 2 %, and 8 % of the error from the input's lines to the result's.
Vec3 CollapseJudge::keep_label_areas(std::uint32_t a, std::uint32_t b, Vec3 x) const {
  if (!state_.adjacency->has_labels()) return x;
  const std::uint32_t before = next_on_line(ring_a_, a, b);
  const std::uint32_t after = next_on_line(ring_b_, b, a);
  if (before == k_none || after == k_none) return x;
  const Vec3 p = state_.positions[before] - middle_;
  const Vec3 q = state_.positions[after] - middle_;
  // Where a line turns back on itself, the area says little about its place.
  if (!(squared_length(p - q) > quadric_.squared_length)) return x;
  const Vec3 half = (state_.positions[b] - state_.positions[a]) * 0.5;
  const Vec3& normal = quadric_.normals;
  return quadric_.moved(x, cross(normal, p - q), dot(normal, cross(half, p + q)), 1);
}

/// A vertex that merges into a line from the side leaves the line unchanged; one that merges into a
/// corner leaves the corner unchanged.
Vec3 CollapseJudge::line_position(std::uint32_t a, std::uint32_t b) const {
  const bool at_a = line_rank(ring_a_.flags) > line_rank(ring_b_.flags);
  return rounded(state_.positions[at_a ? a : b], state_.type);
}

Collapse CollapseJudge::judge(std::uint32_t a, std::uint32_t b, const CollapseLimits& limits) {
  if (state_.adjacency->count(a) + state_.adjacency->count(b) > k_max_star) return {};
  const std::uint32_t shared = list_star(a, b);
  if (shared > limits.triangles) return {};
  if (!link_allows(shared)) return {.by_topology = true};

  const Vec3 half = (state_.positions[b] - state_.positions[a]) * 0.5;
  middle_ = state_.positions[a] + half;
  star_.clear(middle_, half);
  add_star(shared);
  quadric_ = state_.quadric_of(middle_, half);
  star_.sum_planes(quadric_);
  add_appearances(a, b, shared);
  is_ribbon_ = is_ribbon();
  if ((ring_a_.flags & k_line) != 0) add_lines(ring_a_, a, half * -1.0, k_none);
  if ((ring_b_.flags & k_line) != 0) add_lines(ring_b_, b, half, a);
  if (is_ribbon_ && !state_.past.empty() && is_longer_than_ends()) {
    quadric_.add(state_.past[a].about(half));
    quadric_.add(state_.past[b].about(half * -1.0));
  }
  if (state_.has_uvs()) return best_with_uvs(a, b, shared, limits.max_cost);
  return best_of_positions(a, b, shared, limits.max_cost);
}

/// Along a straight edge to a corner, the best point would be the corner, but the ridge of the
/// quadric moves it slightly away, where the surface loses some area. Long straight edges would
/// then cost more than what is around them: six times the error on a lattice of struts at 10 %.
Collapse CollapseJudge::or_at_end(const Collapse& best, std::uint32_t a, std::uint32_t b,
                                  std::uint32_t shared) {
  const Vec3 half = (state_.positions[b] - state_.positions[a]) * 0.5;
  const double at_a = quadric_.cost(half * -1.0);
  const double at_b = quadric_.cost(half);
  const double most = k_next_to_nothing * best.cost;
  if (!(std::min(at_a, at_b) < most)) return best;
  const Vec3 end = state_.positions[at_a <= at_b ? a : b];
  const Collapse there = at_position(end, shared, most, Turn::narrow);
  return there.triangles > 0 ? there : best;
}

/// Whether the piece has only these two vertices and at most four around them.
bool CollapseJudge::is_all_of_piece(std::uint32_t a, std::uint32_t b) const {
  constexpr std::uint32_t k_most_corners = 24;  // of eight triangles
  if (ring_a_.border() || ring_b_.border()) return false;
  std::uint32_t corners = state_.adjacency->count(a) + state_.adjacency->count(b);
  for (std::uint32_t i = 0; i < ring_a_.size; ++i) {
    if (ring_a_.next[i] != b) corners += state_.adjacency->count(ring_a_.next[i]);
  }
  for (std::uint32_t i = 0; i < ring_b_.size; ++i) {
    const std::uint32_t v = ring_b_.next[i];
    if (v != a && count_in(ring_a_, v) == 0) corners += state_.adjacency->count(v);
  }
  return corners <= k_most_corners;
}

/// Whether all vertices of the triangles at both ends are on a border, where no line meets it.
bool CollapseJudge::is_ribbon() const {
  if (!is_on_plain_border(ring_a_.flags) || !is_on_plain_border(ring_b_.flags)) return false;
  const auto is_on_border = [&](std::uint32_t v) { return is_on_plain_border(state_.flags[v]); };
  const auto is_open = [&](const Ring& ring) {
    for (std::uint32_t i = 0; i < ring.size; ++i) {
      if (!is_on_border(ring.next[i]) || !is_on_border(ring.prev[i])) return false;
    }
    return true;
  };
  return is_open(ring_a_) && is_open(ring_b_);
}

/// Between corners in a row, like those of windows, a flat region can only go by leaving a sliver
/// between three of them. Without that, the corners themselves went.
Collapse CollapseJudge::into_line(Vec3 position, std::uint32_t shared, double max_cost) {
  const Collapse made = at_position(position, shared, max_cost, Turn::wide);
  return made.triangles > 0 ? made : at_position(position, shared, max_cost, Turn::sliver);
}

/// Whether some vertex around the edge is neither the end of a ribbon nor merged from one. On a
/// card without such vertices, one of the ends has to move.
bool CollapseJudge::is_longer_than_ends() const {
  const auto has_other = [&](const Ring& ring) {
    for (std::uint32_t i = 0; i < ring.size; ++i) {
      if (state_.past[ring.next[i]].empty() || state_.past[ring.prev[i]].empty()) return true;
    }
    return false;
  };
  return has_other(ring_a_) || has_other(ring_b_);
}

Collapse CollapseJudge::best_of_positions(std::uint32_t a, std::uint32_t b, std::uint32_t shared,
                                          double max_cost) {
  if (line_rank(ring_a_.flags) != line_rank(ring_b_.flags))
    return into_line(line_position(a, b), shared, max_cost);
  const auto at_near = [&](Vec3 x, double most, Turn turn) {
    if (!quadric_.is_near(x)) return Collapse{};
    return at_position(rounded(middle_ + x, state_.type), shared, most, turn);
  };
  const bool keeps_areas = (ring_a_.flags & ring_b_.flags & k_crease) != 0;
  const Vec3 least = quadric_.best();
  const Collapse best =
      at_near(keeps_areas ? keep_label_areas(a, b, least) : least, max_cost, Turn::wide);
  if (best.triangles > 0) return keeps_areas ? best : or_at_end(best, a, b, shared);
  // Where the best point is far off or would spoil a triangle, one of the ends may do: without
  // them, flat faces with sharp edges are dead ends. Letting them turn triangles as far costs 6 %
  // of the error on thin bridges.
  const Vec3 half = (state_.positions[b] - state_.positions[a]) * 0.5;
  const bool a_first = quadric_.cost(half * -1.0) <= quadric_.cost(half);
  const std::array<Vec3, 2> ends = {state_.positions[a_first ? a : b],
                                    state_.positions[a_first ? b : a]};
  for (const Vec3& end : ends) {
    const Collapse there = at_position(end, shared, max_cost, Turn::narrow);
    if (there.triangles > 0) return there;
  }
  if (star_.pairs() <= k_few_pairs) {
    // In pieces that are nearly as small as possible, few collapses keep any of the volume, and
    // those of a three-sided prism turn two of its sides by 60 degrees or more.
    const Collapse cheapest = at_near(quadric_.cheapest(), max_cost, Turn::wide);
    if (cheapest.triangles > 0) return cheapest;
    if (is_all_of_piece(a, b)) return at_near(least, max_cost, Turn::far);
  }
  // The walls of a small hole through a plate cannot close in any other way. If they were left,
  // corners of the plate would go instead.
  const double most = max_cost / k_loss_of_far_turn;
  const auto turned = [&](Turn turn) {
    Collapse made = at_near(least, most, turn);
    for (std::size_t i = 0; i < ends.size() && made.triangles == 0; ++i) {
      made = at_position(ends[i], shared, most, turn);
    }
    made.cost *= k_loss_of_far_turn;
    return made;
  };
  const Collapse far = turned(Turn::far);
  return far.triangles == 0 && may_turn_ribbon() ? turned(Turn::ribbon) : far;
}

/// On lines, only the ends are candidates: no other position is on a line of the texture.
Collapse CollapseJudge::best_with_uvs(std::uint32_t a, std::uint32_t b, std::uint32_t shared,
                                      double max_cost) {
  wedges_.list(state_, a, b, middle_);
  // A border also keeps its place on the texture when another line merges into it from the side.
  const auto rank_of = [](const Ring& ring) {
    return 2 * line_rank(ring.flags) + (ring.border() ? 1 : 0);
  };
  const int rank_a = rank_of(ring_a_);
  const int rank_b = rank_of(ring_b_);
  blends_uvs_ = rank_a == 0 && rank_b == 0 && wedges_.is_even();
  if (blends_uvs_) {
    wedges_.add_to(quadric_);
    return best_of_positions(a, b, shared, max_cost);
  }
  const auto at_end = [&](WedgeStar::End end, double most, Turn turn) {
    const Vec3 position = state_.positions[end == WedgeStar::End::a ? a : b];
    if (!wedges_.place_at(end, position - middle_)) return Collapse{};
    Collapse made = at_position(position, shared, most, turn);
    made.cost += wedges_.cost();
    return made.cost <= most ? made : Collapse{};
  };
  if (rank_a != rank_b) {
    return at_end(rank_a > rank_b ? WedgeStar::End::a : WedgeStar::End::b, max_cost, Turn::wide);
  }
  const auto at_better_end = [&](double most, Turn turn) {
    const Collapse at_a = at_end(WedgeStar::End::a, most, turn);
    const Collapse at_b = at_end(WedgeStar::End::b, at_a.triangles > 0 ? at_a.cost : most, turn);
    if (at_a.triangles == 0 || (at_b.triangles > 0 && at_b.cost < at_a.cost)) return at_b;
    return at_end(WedgeStar::End::a, most, turn);
  };
  const Collapse best = at_better_end(max_cost, Turn::wide);
  if (best.triangles > 0 || !may_turn_ribbon()) return best;
  Collapse turned = at_better_end(max_cost / k_loss_of_far_turn, Turn::ribbon);
  turned.cost *= k_loss_of_far_turn;
  return turned;
}

/// Refused if it costs more than `max_cost` or spoils a triangle.
Collapse CollapseJudge::at_position(Vec3 position, std::uint32_t shared, double max_cost,
                                    Turn turn) {
  const Vec3 x = position - middle_;
  double cost = quadric_.cost(x);
  if (!(cost <= max_cost)) return {};
  const std::optional<double> lost = star_.lost_area(kept_, x, turn);
  if (!lost) return {};
  cost = std::max(cost, quadric_.cost_of_lost_area(*lost) - EdgeQuadric::area_cost_of_bends(cost));
  cost = std::max(cost, star_.cost_of_protruding(1, kept_, x, *lost));
  if (turn == Turn::sliver) cost += star_.cost_of_slivers(1, kept_, x);
  if (!(cost <= max_cost)) return {};
  if (blends_uvs_ && !wedges_.place(x)) return {};
  return {shared, position, cost, false};
}

}  // namespace meshfarm
