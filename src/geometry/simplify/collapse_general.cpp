// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/collapse_general.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "geometry/bvh.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

/// Cost factor of lost area where the topology changes: what goes is farther from what is left than
/// an edge's length, by an unknown distance. From 1 to 30, the error changes by a few per cent.
constexpr double k_loss_of_change = 2;
/// Cost of losing a piece, per area times squared distance from the rest. Other costs are sums over
/// whole triangles of which only one corner moves: they are a few times as great as the area times
/// the squared error. From 6 to 15 the results are alike; with 1 or 40, scans of many pieces lose
/// 10 %.
constexpr double k_loss_of_piece = 10;
/// Cost factor of lost area in a block of cells: walls inside it lose no area, and others stay
/// near. With 5, twice the error.
constexpr double k_loss_of_cells = 25;
constexpr double k_clearly_less = 0.9;

bool contains(const std::vector<std::uint32_t>& sorted, std::uint32_t vertex) {
  return std::binary_search(sorted.begin(), sorted.end(), vertex);
}

bool has(const Corner& corner, std::uint32_t vertex) {
  return corner.next == vertex || corner.prev == vertex;
}

}  // namespace

void GeneralJudge::list_end(std::uint32_t vertex, End& end) {
  end.vertex = vertex;
  end.neighbours.clear();
  end.singular.clear();
  end.open.clear();
  ends_.clear();
  for (const Corner& c : state_.adjacency->at(vertex)) {
    ends_.push_back(c.next);
    ends_.push_back(c.prev);
  }
  std::sort(ends_.begin(), ends_.end());
  end.crowded = 0;
  for (std::size_t first = 0, last = 0; first < ends_.size(); first = last) {
    while (last < ends_.size() && ends_[last] == ends_[first]) ++last;
    end.neighbours.push_back(ends_[first]);
    if (last - first != 2) end.singular.push_back(ends_[first]);
    if (last - first == 1) end.open.push_back(ends_[first]);
    end.crowded += last - first > 2 ? 1 : 0;
  }
  end.rank = line_rank(state_.flags[vertex]);
  if (!end.singular.empty()) end.rank = std::max(end.rank, end.singular.size() == 2 ? 1 : 2);
}

void GeneralJudge::list_triangles() {
  shared_.clear();
  kept_.clear();
  for (const Corner& c : state_.adjacency->at(a_.vertex)) {
    if (has(c, b_.vertex)) {
      shared_.push_back(c);
    } else {
      kept_.push_back({c, false});
    }
  }
  for (const Corner& c : state_.adjacency->at(b_.vertex)) {
    if (!has(c, a_.vertex)) kept_.push_back({c, true});
  }
}

/// Of two triangles that become equal, both go if they face opposite ways; if they face the same
/// way, that of b goes.
void GeneralJudge::find_vanishing() {
  vanishing_.clear();
  for (Kept& of_b : kept_) {
    if (!of_b.at_b) continue;
    const auto [next, prev] = of_b.corner;
    if (!contains(a_.neighbours, next) || !contains(a_.neighbours, prev)) continue;
    for (Kept& of_a : kept_) {
      if (of_a.at_b) break;
      const Corner& c = of_a.corner;
      if (of_a.vanishes || !has(c, next) || !has(c, prev)) continue;
      of_b.vanishes = true;
      vanishing_.emplace_back(next, prev);
      if (c.next != prev) break;
      of_a.vanishes = true;
      vanishing_.emplace_back(c.next, c.prev);
      break;
    }
  }
  std::stable_partition(kept_.begin(), kept_.end(), [](const Kept& k) { return !k.vanishes; });
  staying_ = static_cast<std::uint32_t>(kept_.size() - vanishing_.size());
  removed_ = static_cast<std::uint32_t>(shared_.size() + vanishing_.size());
}

/// The link condition (Dey, Edelsbrunner, Guha, Nekhayev 1999), with all singular edges joined to
/// one vertex at infinity.
bool GeneralJudge::changes_topology() {
  changed_.clear();
  std::set_intersection(a_.neighbours.begin(), a_.neighbours.end(), b_.neighbours.begin(),
                        b_.neighbours.end(), std::back_inserter(changed_));
  const bool extra = changed_.size() != shared_.size();
  const bool along = contains(a_.singular, b_.vertex);
  const bool both = !a_.singular.empty() && !b_.singular.empty();
  if (both && !along) return true;
  const bool loop = both && std::any_of(a_.singular.begin(), a_.singular.end(),
                                        [&](auto v) { return contains(b_.singular, v); });
  return extra || loop || !vanishing_.empty() || staying_ == 0;
}

/// Whether the edge from an end to a neighbour has more than one triangle on either side.
bool GeneralJudge::is_crowded(std::uint32_t vertex, const End& end) const {
  int begin = 0;
  int all = 0;
  for (const Corner& c : state_.adjacency->at(end.vertex)) {
    begin += c.next == vertex ? 1 : 0;
    all += has(c, vertex) ? 1 : 0;
  }
  return begin > 1 || all - begin > 1;
}

/// Whether two uncrowded edges become one that is crowded even after pinched vertices are cut
/// apart. A result must be no less manifold than its input.
bool GeneralJudge::crowds_an_edge() {
  merged_.clear();
  for (std::size_t i = 0; i < staying_; ++i) merged_.push_back(kept_[i].corner);
  std::span<const std::uint32_t> fans;
  for (const std::uint32_t v : changed_) {
    joined_.clear();
    for (std::uint32_t i = 0; i < staying_; ++i) {
      if (has(merged_[i], v)) joined_.push_back(i);
    }
    if (joined_.size() < 2 || is_crowded(v, a_) || is_crowded(v, b_)) continue;
    if (fans.empty()) splitter_.split(merged_);
    fans = splitter_.fans();
    for (const std::uint32_t i : joined_) {
      for (const std::uint32_t k : joined_) {
        const bool same_side = (merged_[i].next == v) == (merged_[k].next == v);
        if (k < i && same_side && fans[i] == fans[k]) return true;
      }
    }
  }
  return false;
}

void GeneralJudge::add_star(Vec3 half) {
  middle_ = state_.positions[a_.vertex] + half;
  star_.clear(middle_, half);
  const Vec3* const positions = state_.positions.data();
  const Corner none{a_.vertex, a_.vertex};
  const auto add = [&](const Corner& c0, const Corner& c1, CollapseStar::Pair sides) {
    star_.add({positions[c0.next], positions[c0.prev], positions[c1.next], positions[c1.prev]},
              sides);
  };
  const auto kept_at = [&](std::size_t i) { return i < kept_.size() ? kept_[i].corner : none; };
  const auto side = [&](std::size_t i) { return i < kept_.size() && kept_[i].at_b ? 1.0 : -1.0; };
  // Triangles that stay come first: only they are checked again for each position.
  for (std::size_t i = 0; i < staying_; i += 2) {
    const bool pair = i + 1 < staying_;
    add(kept_at(i), pair ? kept_at(i + 1) : none,
        CollapseStar::Pair{side(i), pair ? side(i + 1) : -1.0});
  }
  for (std::size_t i = staying_; i < kept_.size(); i += 2) {
    add(kept_at(i), kept_at(i + 1), CollapseStar::Pair{side(i), side(i + 1)});
  }
  for (std::size_t i = 0; i < shared_.size(); i += 2) {
    add(shared_[i], i + 1 < shared_.size() ? shared_[i + 1] : none, CollapseStar::Pair{-1.0, -1.0});
  }
  quadric_ = state_.quadric_of(middle_, half);
  star_.sum_planes(quadric_);
  add_appearances();
}

/// Call after the star is listed: triangles that stay, vanishing ones and shared ones each begin at
/// an even place.
void GeneralJudge::add_appearances() {
  if (state_.appearances.empty()) return;
  appearance_.clear(state_.appearance_scale);
  const auto even = [](std::size_t place) { return place + place % 2; };
  const std::size_t vanishing = even(staying_);
  const std::size_t shared = even(vanishing + kept_.size() - staying_);
  const auto add = [&](std::size_t place, std::uint32_t vertex, const Corner& c) {
    appearance_.add(star_.triangle(static_cast<std::uint32_t>(place)), state_.values_at(vertex, c));
  };
  for (std::size_t i = 0; i < shared_.size(); ++i) add(shared + i, a_.vertex, shared_[i]);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const std::size_t place = i < staying_ ? i : vanishing + i - staying_;
    add(place, (kept_[i].at_b ? b_ : a_).vertex, kept_[i].corner);
  }
  appearance_.add_to(quadric_);
}

/// Adds the planes along the open edges of one end. Where three or more sheets meet, their own
/// planes hold the line: with extra planes, jags of lines outweighed the sheets between them.
void GeneralJudge::add_lines(const End& end, const End& other, Vec3 at) {
  if (end.open.empty()) return;
  Quadric planes;
  const Vec3 position = state_.positions[end.vertex];
  for (const Corner& c : state_.adjacency->at(end.vertex)) {
    const Vec3 normal =
        cross(state_.positions[c.next] - position, state_.positions[c.prev] - position);
    for (const std::uint32_t v : {c.next, c.prev}) {
      const bool counted = v == other.vertex && end.vertex > other.vertex;
      if (counted || !contains(end.open, v)) continue;
      add_line_plane(planes, normal, state_.positions[v] - position, k_border_weight);
    }
  }
  quadric_.add(planes, at);
}

/// Whether the merged vertex may go to x, one of the ends.
bool GeneralJudge::may_go_to(Vec3 x) const {
  return star_.lost_area_from(0, staying_, x, {.turn = Turn::wide}).has_value();
}

Collapse GeneralJudge::at_position(Vec3 position, Turn turn) const {
  const Vec3 x = position - middle_;
  const std::optional<double> lost = star_.lost_area_from(0, staying_, x, {.turn = turn});
  if (!lost) return {};
  const double lost_cost =
      std::max(quadric_.cost_of_lost_area(*lost), star_.cost_of_protruding(0, staying_, x, *lost));
  const double planes = std::max(quadric_.cost(x), cost_of_past(x));
  const double times = (changes_ ? k_loss_of_change : 1) * (is_of_cells() ? k_loss_of_cells : 1);
  const double slivers = turn == Turn::sliver ? star_.cost_of_slivers(0, staying_, x) : 0;
  const double cost = std::max(planes, lost_cost * times) + slivers;
  return {removed_, position, cost, false, std::max(planes, lost_cost) + slivers};
}

Collapse GeneralJudge::at_best(Turn turn) const {
  const Vec3 x = quadric_.best();
  if (!quadric_.is_near(x)) return {};
  return at_position(rounded(middle_ + x, state_.type), turn);
}

/// The cost by past planes. Where sheets meet everywhere, the outermost parts have the fewest
/// triangles and would always be the cheapest to draw back: by a little each time, as far as the
/// current mesh can tell.
double GeneralJudge::cost_of_past(Vec3 x) const {
  if (state_.past.empty()) return 0;
  return quadric_.unless_noise(state_.past[a_.vertex].cost(x + half_) +
                               state_.past[b_.vertex].cost(x - half_));
}

/// Whether all triangles at `vertex`, a neighbour of the two ends, go.
bool GeneralJudge::is_lost(std::uint32_t vertex) const {
  std::ptrdiff_t gone = std::count_if(shared_.begin(), shared_.end(),
                                      [&](const Corner& c) { return has(c, vertex); });
  gone += std::count_if(kept_.begin() + staying_, kept_.end(),
                        [&](const Kept& k) { return has(k.corner, vertex); });
  return gone == static_cast<std::ptrdiff_t>(state_.adjacency->count(vertex));
}

/// Lists the vertices that lose all their triangles.
void GeneralJudge::list_lost() {
  lost_.clear();
  if (staying_ == 0) lost_.assign({a_.vertex, b_.vertex});
  const auto list = [&](std::uint32_t vertex) {
    if (is_lost(vertex)) lost_.push_back(vertex);
  };
  for (const Corner& c : shared_) list(c.next == b_.vertex ? c.prev : c.next);
  for (const auto& [next, prev] : vanishing_) {
    list(next);
    list(prev);
  }
  std::sort(lost_.begin(), lost_.end());
  lost_.erase(std::unique(lost_.begin(), lost_.end()), lost_.end());
}

/// The squared distance to what will cover the foot of a needle or fin, where two of its triangles
/// close upon each other; infinite if nothing will.
double GeneralJudge::squared_to_cover(Vec3 from) const {
  double squared = HUGE_VAL;
  if (staying_ == 0) return squared;
  for (const auto& [next, prev] : vanishing_) {
    if (contains(lost_, next) == contains(lost_, prev)) continue;
    const std::uint32_t left = contains(lost_, next) ? prev : next;
    squared =
        std::min(squared, squared_distance(from, state_.positions[a_.vertex],
                                           state_.positions[b_.vertex], state_.positions[left]));
  }
  return squared;
}

/// Lists points only if nothing but the triangles at the edge is lost: what stands for a leaf or a
/// hair may be close to others in its middle, and far from everything at its ends.
void GeneralJudge::list_points_of_sheet() {
  points_of_sheet_.clear();
  if (!kept_.empty()) return;
  for (const Corner& c : shared_) {
    const Vec3 p = state_.positions[a_.vertex];
    const Vec3 q = state_.positions[c.next];
    const Vec3 r = state_.positions[c.prev];
    const Vec3 middle = (p + q + r) * (1.0 / 3);
    for (const Vec3& corner : {p, q, r}) points_of_sheet_.push_back((middle + corner) * 0.5);
  }
}

/// The cost of the triangles that go with the lost vertices, by their distance from the rest.
double GeneralJudge::cost_of_lost() {
  if (!any_topology_ || lost_.empty()) return 0;
  Vec3 sum;
  double area = 0;
  const auto add = [&](std::uint32_t end, const Corner& c) {
    if (!contains(lost_, end) && !contains(lost_, c.next) && !contains(lost_, c.prev)) return;
    const Vec3 at = state_.positions[end];
    const Vec3 p = state_.positions[c.next];
    const Vec3 q = state_.positions[c.prev];
    const double twice_area = length(cross(p - at, q - at));
    area += 0.5 * twice_area;
    sum = sum + (at + p + q) * (0.5 * twice_area / 3);
  };
  for (const Corner& c : shared_) add(a_.vertex, c);
  for (std::size_t i = staying_; i < kept_.size(); ++i) {
    add((kept_[i].at_b ? b_ : a_).vertex, kept_[i].corner);
  }
  if (area == 0) return 0;
  const Vec3 middle = sum * (1 / area);
  list_points_of_sheet();
  const double squared = surroundings_.squared_distance(
      {state_.positions, state_.target, state_.adjacency}, {middle, points_of_sheet_, lost_});
  return k_loss_of_piece * area * std::min(squared, squared_to_cover(middle));
}

/// Adds the cost of needles and fins that go with the edge at their foot: planes only tell how far
/// the foot moves.
void GeneralJudge::add_cost_of_tips(Collapse& collapse) {
  list_lost();
  const double cost = cost_of_lost();
  collapse.cost += cost;
  collapse.certain += cost;
}

/// Whether the triangles at both ends are a whole closed piece.
bool GeneralJudge::is_closed_piece() const {
  const auto is_free = [&](std::uint32_t v) {
    return (state_.flags[v] & (k_fixed | k_border | k_complex)) == 0 && contains(lost_, v);
  };
  return shared_.size() == 2 && std::all_of(a_.neighbours.begin(), a_.neighbours.end(), is_free) &&
         std::all_of(b_.neighbours.begin(), b_.neighbours.end(), is_free);
}

/// Call after the lost vertices are listed.
bool GeneralJudge::is_tetrahedron() const {
  return lost_.size() == 4 && shared_.size() == 2 && kept_.size() == 2;
}

/// All edges of a triangle and of a tetrahedron end it. If all triangles are at one edge, only that
/// edge does.
void GeneralJudge::list_ends_of_piece() {
  const bool is_triangle = kept_.empty() && shared_.size() == 1;
  if (is_triangle || is_tetrahedron()) {
    ends_of_piece_ = lost_;
  } else if (kept_.empty()) {
    ends_of_piece_ = {a_.vertex, b_.vertex};
  }
}

/// Opens a piece where that costs least: the triangles at one end of the edge go, of a tetrahedron
/// the two at any of its edges.
Collapse GeneralJudge::opening() {
  std::vector<Triangle>& piece = triangles_of_piece_;
  piece.clear();
  for (const Corner& c : shared_) piece.push_back({a_.vertex, c.next, c.prev});
  for (const Kept& k : kept_) {
    piece.push_back({(k.at_b ? b_ : a_).vertex, k.corner.next, k.corner.prev});
  }
  Collapse best;
  const auto try_without = [&](std::uint32_t v, std::uint32_t w) {
    const auto goes = [&](const Triangle& t) { return has_corner(t, v) && has_corner(t, w); };
    const auto standing = std::stable_partition(piece.begin(), piece.end(), goes);
    const double cost = cost_of_opening({piece.begin(), standing}, {standing, piece.end()});
    if (best.triangles > 0 && cost >= best.cost) return;
    going_.assign(piece.begin(), standing);
    best = {static_cast<std::uint32_t>(going_.size()), middle_, cost, false};
    best.opens = true;
  };
  if (!is_tetrahedron()) {
    for (const std::uint32_t v : {b_.vertex, a_.vertex}) try_without(v, v);
    return best;
  }
  for (std::size_t i = 0; i < lost_.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) try_without(lost_[i], lost_[k]);
  }
  return best;
}

/// The cost by the distance of the removed triangles from those that stand for them, measured at
/// the middles of the quarters of each triangle.
double GeneralJudge::cost_of_opening(std::span<const Triangle> going,
                                     std::span<const Triangle> standing) const {
  const auto corners_of = [&](const Triangle& t) {
    return std::array{state_.positions[t[0]], state_.positions[t[1]], state_.positions[t[2]]};
  };
  const auto squared_from = [&](Vec3 point) {
    double squared = HUGE_VAL;
    for (const Triangle& t : standing) {
      const auto [p, q, r] = corners_of(t);
      squared = std::min(squared, squared_distance(point, p, q, r));
    }
    return squared;
  };
  double cost = 0;
  for (const Triangle& t : going) {
    const auto corners = corners_of(t);
    const auto& [p, q, r] = corners;
    const Vec3 middle = (p + q + r) * (1.0 / 3);
    double sum = squared_from(middle);
    for (const Vec3 corner : corners) sum += squared_from((middle + corner) * 0.5);
    cost += 0.5 * length(cross(q - p, r - p)) * sum / 4;
  }
  return k_loss_of_piece * cost;
}

/// No triangle would stay: either all go, or some of a closed piece stay and stand for the others.
/// For a thin plate or a pin, one sheet does as well as two.
Collapse GeneralJudge::end_of_piece(std::uint64_t most_triangles) {
  list_lost();
  list_ends_of_piece();
  going_.clear();
  Collapse best;
  if (removed_ <= most_triangles) best = {removed_, middle_, cost_of_lost(), false};
  if (!may_open_ || !is_closed_piece()) return best;
  const Collapse opened = opening();
  const bool is_better = best.triangles == 0 || opened.cost < best.cost;
  return opened.triangles <= most_triangles && is_better ? opened : best;
}

GeneralCollapse GeneralJudge::judge(std::uint32_t a, std::uint32_t b,
                                    std::uint64_t most_triangles) {
  ends_of_piece_.clear();
  if (state_.adjacency->count(a) + state_.adjacency->count(b) > k_max_star) return {};
  list_end(a, a_);
  list_end(b, b_);
  list_triangles();
  if (shared_.empty()) return {};
  find_vanishing();
  if (removed_ > most_triangles && staying_ > 0) return {};
  GeneralCollapse result;
  result.changes_topology = changes_ = changes_topology();
  if (changes_ && crowds_an_edge()) return {};
  half_ = (state_.positions[b] - state_.positions[a]) * 0.5;
  wedges_.clear();
  if (staying_ == 0) {
    appearance_.clear(state_.appearance_scale);
    middle_ = state_.positions[a] + half_;
    result.collapse = end_of_piece(most_triangles);
    return result;
  }
  add_star(half_);
  // Most refused collapses are refused here.
  if (a_.rank == 2 && b_.rank == 2 && !may_go_to(half_ * -1.0) && !may_go_to(half_)) return result;
  add_lines(a_, b_, half_ * -1.0);
  add_lines(b_, a_, half_);
  result.collapse = state_.has_uvs() ? best_with_uvs() : best_of_positions();
  if (changes_ && result.collapse.triangles > 0) add_cost_of_tips(result.collapse);
  return result;
}

Collapse GeneralJudge::best_of_positions() {
  const Vec3 at_a = state_.positions[a_.vertex];
  const Vec3 at_b = state_.positions[b_.vertex];
  if (a_.rank != b_.rank) return or_beside_line(into_line(a_.rank > b_.rank ? at_a : at_b));
  if (a_.rank < 2) {
    const Collapse best = at_best(Turn::wide);
    if (best.triangles > 0) return best;
  }
  const bool a_first = quadric_.cost(half_ * -1.0) <= quadric_.cost(half_);
  const std::array<Vec3, 2> ends = {a_first ? at_a : at_b, a_first ? at_b : at_a};
  const Turn turn = a_.rank < 2 ? Turn::narrow : Turn::wide;
  for (const Vec3& end : ends) {
    const Collapse there = at_position(end, turn);
    if (there.triangles > 0) return there;
  }
  return turned_far(ends);
}

/// As CollapseJudge does.
Collapse GeneralJudge::into_line(Vec3 position) const {
  const Collapse made = at_position(position, Turn::wide);
  return made.triangles > 0 ? made : at_position(position, Turn::sliver);
}

/// Where sheets meet and there is no border or crease, takes the best point instead if it costs
/// clearly less: flat sheets meet where the line is. Kept on the line, cells of an irregular block
/// have up to 7 % more error.
Collapse GeneralJudge::or_beside_line(const Collapse& on_line) const {
  const std::uint8_t flags = state_.flags[a_.vertex] | state_.flags[b_.vertex];
  if ((flags & k_line) != 0) return on_line;
  const Collapse best = at_best(Turn::wide);
  const bool is_better =
      best.triangles > 0 && (on_line.triangles == 0 || best.cost < k_clearly_less * on_line.cost);
  return is_better ? best : on_line;
}

/// As CollapseJudge does, where every place turns a triangle by more than 60 degrees.
Collapse GeneralJudge::turned_far(std::span<const Vec3, 2> ends) const {
  Collapse far;
  if (a_.rank < 2) far = at_best(Turn::far);
  for (std::size_t i = 0; i < ends.size() && far.triangles == 0; ++i) {
    far = at_position(ends[i], Turn::far);
  }
  far.cost *= k_loss_of_far_turn;
  far.certain *= k_loss_of_far_turn;
  return far;
}

/// Only at the ends, wherever they are: a rare case may be less good.
Collapse GeneralJudge::best_with_uvs() {
  wedges_.list(state_, a_.vertex, b_.vertex, middle_);
  const auto at_end = [&](WedgeStar::End end) {
    const bool is_a = end == WedgeStar::End::a;
    if ((is_a ? a_.rank < b_.rank : b_.rank < a_.rank)) return Collapse{};
    const Vec3 position = state_.positions[(is_a ? a_ : b_).vertex];
    if (!wedges_.place_at(end, position - middle_)) return Collapse{};
    Collapse made = at_position(position, a_.rank == b_.rank ? Turn::narrow : Turn::wide);
    made.cost += wedges_.cost();
    made.certain += wedges_.cost();
    return made;
  };
  const Collapse at_a = at_end(WedgeStar::End::a);
  const Collapse at_b = at_end(WedgeStar::End::b);
  if (at_a.triangles == 0 || (at_b.triangles > 0 && at_b.cost < at_a.cost)) return at_b;
  return at_end(WedgeStar::End::a);
}

}  // namespace meshfarm
