// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/simplify_queue.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/simplify/vertex_flags.hpp"
#include "geometry/simplify/working_mesh.hpp"
#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_told_every = 4096;  // collapses

// The share of edges ranked at a time, the cheapest; more expensive ones are not kept in order.
// This affects the order of collapses only where an edge becomes cheaper without being judged
// again.
constexpr double k_ranked_share = 0.35;
// From one cost limit to the next, the order continues while more than this share of the ranked
// triangles is left.
constexpr double k_as_ranked = 0.8;
// A collapse of complex vertices removes more than two triangles, but rarely more than this.
constexpr std::uint64_t k_few_to_go = 16;
// Cost factor of a collapse that leaves fewer triangles than the goal. When none was allowed, a
// board with pieces of four triangles gave up two of its corners for the last two triangles.
constexpr double k_loss_of_fewer = 4;
// The factor where just one triangle is too many. The cost is also at least the greatest paid so
// far, and at least that of a distance of 1e-5 edges over a square on the edge. So the count is met
// exactly, at a border, unless that costs ten times the distance. On coarse ground under a fine
// model it did.
constexpr double k_loss_of_one_fewer = 100;
constexpr double k_nothing = 1e-10;
// For goals of at least this many triangles, one fewer is as good, if need be.
constexpr std::uint64_t k_goal_of_one_fewer = 1000;
// A kept mesh is dropped once it has more than this many times the triangles that are left.
constexpr double k_far_more = 1.3;

// Cost factor of a collapse that makes triangles cross: eight times the distance. With 16, more
// than twice as many of a skull's triangles cross; with 1,024, walls thinner than the error lose
// their shape.
constexpr double k_loss_of_crossing = 64;

// Cost factor for a closed piece that was opened. What is left stands for both of its sides, and
// its planes know nothing of the side that is gone. With 2, bearings at 0.3 % have 1.36 times the
// error; with 40, ten meshes have 0.94 to 1.02 times.
constexpr double k_loss_of_opened = 8;

// Closed pieces, and what is pinched off from them, are opened where the goal has less than this
// many times the triangles that all pieces need at least. With 1, tubes as thin as hairs have 3 to
// 4 times the error; with 2, a scan in tiles and a skull have up to 3 % more. Without this limit,
// no surface would stay closed. With pinched pieces kept closed, a thin corrugated sheet falls to
// crumbs, with twice the error.
constexpr std::uint64_t k_room_of_piece = 4;
// Pieces are counted again at the earliest after one pinch per this many triangles of the goal.
constexpr std::uint64_t k_goal_of_count = 64;

// Cost factor for the leftovers of pinching: they face the wrong way more often than not. With
// 1/64, fewer triangles do, but a skull has 7 % more error.
constexpr double k_cost_of_left_over = 0.125;

// A refused edge of a complex vertex is judged again after one change per this many triangles
// around it. In a block of cells most edges are refused: judging all of them after each collapse
// takes twice as long, with the same error.
constexpr std::uint32_t k_complex_changes = 16;

// Edges are re-ranked in double precision once this many waits per collapse, and at least this many
// waits in all, show that the ranking is too coarse.
constexpr std::uint64_t k_waits_of_rough = 4;
constexpr std::uint64_t k_least_waits = 1000;

constexpr CostKey k_greatest = k_any_cost - 1;
constexpr CostKey k_least_step = 4U << 20;  // a factor of 16

// Above this many topology refusals per collapse, everything that is left is expensive. Only
// refusals of edges cheaper than the greatest cost paid so far count: on a thin tube, all edges
// around it are refused whenever one along it collapses. A surface of many handles whose result was
// still good had 1.6.
constexpr std::uint64_t k_hopeless = 4;
// Refusals allowed per triangle in addition: after each ranking, all edges may be judged twice
// before the queue gives up.
constexpr std::uint64_t k_edges_of_triangle = 3;

/// How many triangles fewer than the goal may be left. Together with the one by which the goal
/// itself may be below what was asked for, as triangles of closed surfaces go in pairs, it is 0.1 %
/// of large goals and 2 % of small ones. Small goals allow just one while any other edge may do;
/// large ones allow one more once no other does.
std::uint64_t most_fewer(std::uint64_t goal, bool nothing_else_does) {
  constexpr std::uint64_t k_few = 100;
  if (goal >= k_goal_of_one_fewer) return goal / k_goal_of_one_fewer - (nothing_else_does ? 0 : 1);
  if (goal < k_few) return 0;
  return nothing_else_does ? goal / (k_few / 2) - 1 : 1;
}

/// Triangles that a collapse may remove.
std::uint64_t most_at_once(std::uint64_t excess, std::uint64_t goal, bool nothing_else_does) {
  if (excess == 1 && goal < k_goal_of_one_fewer) return excess;
  return excess < k_few_to_go ? excess + most_fewer(goal, nothing_else_does) : excess;
}

/// Four triangles for each closed component, two for each that is fixed, open or complex; 0 if
/// there is only one component.
std::uint64_t room_for_all(std::span<const std::uint8_t> flags, const Adjacency& adjacency) {
  enum : std::uint8_t { k_used = 1, k_unclosed = 2 };
  const auto vertices = static_cast<std::uint32_t>(flags.size());
  UnionFind components(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    for (const Corner& c : adjacency.at(v)) components.join(v, c.next);
  }
  std::vector<std::uint8_t> kinds(vertices, 0);  // of each component, at its vertex
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (adjacency.count(v) == 0) continue;
    const bool is_unclosed = (flags[v] & (k_fixed | k_border | k_complex)) != 0;
    kinds[components.find(v)] |= is_unclosed ? k_used | k_unclosed : k_used;
  }
  const auto all = vertices - std::count(kinds.begin(), kinds.end(), 0);
  const auto closed = std::count(kinds.begin(), kinds.end(), k_used);
  return all > 1 ? static_cast<std::uint64_t>(2 * all + 2 * closed) : 0;
}

}  // namespace

CollapseQueue::CollapseQueue(const QueuedMesh& mesh, EdgeRanking& ranking)
    : mesh_(mesh), ranking_(ranking), judge_(state()), general_(state(), mesh.any_topology) {}

void CollapseQueue::start(std::span<const Triangle> triangles) {
  const auto vertices = static_cast<std::uint32_t>(mesh_.positions.size());
  triangles_ = triangles.size();
  target_.resize(vertices);
  std::iota(target_.begin(), target_.end(), 0U);
  refused_.assign(vertices, 0);
  looks_.assign(vertices, 0);
  stale_.assign(vertices, 0);
  piece_ends_.assign(mesh_.any_topology ? vertices : 0, {});
  heap_.clear();
  remember();
  ranking_.begin_pass({mesh_.positions, triangles, mesh_.flags, &mesh_.adjacency,
                       &mesh_.creases.test(), mesh_.seam_only, true, mesh_.any_topology, true,
                       mesh_.appearances, mesh_.appearance_scale, mesh_.uv_scale});
  judge_.move_to(state());
  general_.move_to(state());
}

/// Ranks the cheapest share of all edges, at least up to a limit one step above the last one.
void CollapseQueue::rank(double share) {
  for (std::uint32_t v = 0; v < target_.size(); ++v) refresh(v);
  const CostKey wanted = share < 1 ? ranking_.estimate_limit(share, HUGE_VAL) : k_greatest;
  limit_ = std::min(std::max(wanted, limit_ + k_least_step), k_greatest);
  heap_.clear();
  first_.clear();
  next_first_ = 0;
  blocked_before_ = blocked_;
  collapses_before_ = collapses_;
  waited_ = 0;
  ranked_at_ = triangles_;
  for (PieceEnd& end : piece_ends_) end.a = end.b = 0;
  const auto vertices = static_cast<std::uint32_t>(target_.size());
  for (const RankedEdge& e : ranking_.cheapest(0, vertices, {limit_, HUGE_VAL})) {
    first_.emplace_back(e, stamp_of(e.a, e.b));
  }
}

void CollapseQueue::refresh(std::uint32_t vertex) {
  if (stale_[vertex] == 0) return;
  ranking_.refresh(vertex);
  stale_[vertex] = 0;
}

void CollapseQueue::push(const RankedEdge& edge) {
  if (edge.key > limit_) return;
  heap_.emplace(edge, stamp_of(edge.a, edge.b));
}

const QueuedEdge* CollapseQueue::next() const {
  const bool ranked = next_first_ < first_.size();
  if (heap_.empty()) return ranked ? &first_[next_first_] : nullptr;
  const QueuedEdge& top = heap_.top();
  return ranked && !first_[next_first_].is_later(top) ? &first_[next_first_] : &top;
}

void CollapseQueue::drop_next() {
  if (heap_.empty() || next() != &heap_.top()) {
    ++next_first_;
    return;
  }
  heap_.pop();
}

CollapseState CollapseQueue::state() {
  return {mesh_.positions,
          mesh_.flags,
          target_,
          &mesh_.adjacency,
          mesh_.type,
          &mesh_.creases.test(),
          mesh_.appearances,
          mesh_.appearance_scale,
          mesh_.uv_scale,
          past_,
          true};
}

Collapse CollapseQueue::judge(std::uint32_t a, std::uint32_t b, std::uint64_t most_triangles) {
  by_general_ = ((mesh_.flags[a] | mesh_.flags[b]) & k_complex) != 0;
  if (!by_general_) {
    const Collapse collapse = judge_.judge(a, b, {most_triangles, HUGE_VAL});
    if (collapse.triangles > 0 || !collapse.by_topology) return collapse;
    if (!mesh_.any_topology) {
      ++kept_topology_;
      return {};
    }
  }
  const GeneralCollapse general = general_.judge(a, b, most_triangles);
  by_general_ = true;
  if (!general.changes_topology || mesh_.any_topology) return general.collapse;
  kept_topology_ += general.collapse.triangles > 0 ? 1 : 0;
  return {};
}

void CollapseQueue::set_guard(CollapseGuard& guard, const Mesh& mesh) {
  guard_ = &guard;
  guard.start(state(), mesh);
}

void CollapseQueue::set_guard(CrossingGuard& guard, std::span<const Triangle> triangles) {
  crossings_ = &guard;
  guard.start(state(), triangles, CrossingGuard::Where::everywhere);
}

CollapseGuard::Merge CollapseQueue::planned(std::uint32_t a, std::uint32_t b,
                                            const Collapse& collapse) const {
  CollapseGuard::Merge merge{a, b, collapse.position, {}};
  if (by_general_) merge.vanishing = general_.vanishing();
  return merge;
}

/// Whether triangles would cross and other edges should go first. If so, the edge waits or is
/// refused.
bool CollapseQueue::must_not_cross(const QueuedEdge& queued, const Collapse& collapse) {
  if (crossings_ == nullptr) return false;
  const std::uint32_t a = queued.a();
  const std::uint32_t b = queued.b;
  if (!crossings_->crosses(planned(a, b, collapse))) return false;
  const double cost = collapse.cost * k_loss_of_crossing;
  // With a bound on the error, crossings are not accepted at any cost.
  if (guard_ != nullptr) {
    refused_[a] = refused_[b] = 1;
    return true;
  }
  if (!must_wait(queued, cost)) return false;
  // By then it may no longer cross anything.
  if (cost > most_cost_) refused_[a] = refused_[b] = 1;
  wait(queued, cost);
  return true;
}

/// Whether the bound forbids the collapse. Such an edge is judged again when one of its ends has
/// moved, not when something around it has.
bool CollapseQueue::is_guarded(std::uint32_t a, std::uint32_t b, const Collapse& collapse) {
  if (guard_ == nullptr) return false;
  return !guard_->allows(planned(a, b, collapse));
}

/// Lets closed pieces open from now on, and what is pinched off from them, if the pieces need room
/// to leave `last` triangles. They are counted again and again, as tubes close and sheets fall to
/// pieces on the way. Returns whether they may open now and might not before.
bool CollapseQueue::let_open_for_room(std::uint64_t last) {
  if (!mesh_.any_topology || guard_ != nullptr || crossings_ != nullptr) return false;
  if (last == 0 || general_.may_open()) return false;
  const std::uint64_t needed = k_room_of_piece * room_for_all(mesh_.flags, mesh_.adjacency);
  pinches_ = 0;
  if (last < needed) {
    general_.let_open();
    piece_ends_.assign(piece_ends_.size(), {});
    return true;
  }
  // A pinch makes at most one more closed piece.
  const std::uint64_t room = (last - needed) / (4 * k_room_of_piece);
  pinches_to_count_ = std::max(room, last / k_goal_of_count) + 1;
  return false;
}

bool CollapseQueue::reduce(const SimplifyGoal& goal, const Progress& progress) {
  most_cost_ = goal.max_cost;
  double share = k_ranked_share;
  bool is_ranked = limit_ > 0 && std::isfinite(goal.max_cost) &&
                   static_cast<double>(triangles_) > k_as_ranked * static_cast<double>(ranked_at_);
  if (!is_ranked) limit_ = 0;
  ends_ = false;
  while (triangles_ > goal.triangles) {
    const std::uint64_t before = triangles_;
    const bool goes_on = std::exchange(is_ranked, false);
    if (!goes_on) rank(share);
    let_open_for_room(last_of(goal));
    const Stop stop = run(goal, progress);
    held_ = held_ || stop == Stop::held;
    if (stop == Stop::too_rough) ranking_.refine();
    if (stop == Stop::too_rough || stop == Stop::opened) {
      limit_ = 0;
      continue;
    }
    // Edges refused because they would remove too many triangles may do for the next goal.
    if (triangles_ < goal.triangles + k_few_to_go) ranked_at_ = UINT64_MAX;
    if (stop != Stop::nothing_left) return stop != Stop::told;
    if (limit_ >= std::min(key_of(most_cost_), k_greatest)) {
      // In a block of cells, each edge that is left may have more triangles than are still to go.
      if (ends_ || triangles_ >= goal.triangles + k_few_to_go) return true;
      ends_ = true;
    }
    // Dead end: the ranked edges are refused again and again.
    if (!goes_on && (before - triangles_) * 50 < before) share = 1;
  }
  return true;
}

CollapseQueue::Stop CollapseQueue::run(const SimplifyGoal& goal, const Progress& progress) {
  std::uint64_t collapses = 0;
  const CostKey dearest = key_of(goal.max_cost);
  std::optional<bool> may_be_odd;  // asked once
  while (triangles_ > goal.triangles) {
    // At least one triangle stays, whatever the goal.
    const std::uint64_t excess = triangles_ - std::max<std::uint64_t>(1, goal.triangles);
    if (excess == 0) return Stop::met;
    if (excess == 1 && !may_be_odd) may_be_odd = may_lose_one();
    if (excess == 1 && !*may_be_odd) return Stop::met;
    if (is_hopeless()) return Stop::held;
    if (is_too_rough()) return Stop::too_rough;
    if (pinches_ >= pinches_to_count_ && let_open_for_room(last_of(goal))) return Stop::opened;
    const QueuedEdge* const first = next();
    if (first == nullptr || first->key() > dearest) return Stop::nothing_left;
    const QueuedEdge queued = *first;
    drop_next();
    const std::uint32_t a = queued.a();
    const std::uint32_t b = queued.b;
    if (is_gone(a) || is_gone(b) || queued.stamp != stamp_of(a, b)) continue;
    if (is_queued_otherwise(queued)) continue;
    if (const double least = cost_of_piece(a, b); must_wait(queued, least)) {
      wait(queued, least);
      continue;
    }
    const std::uint64_t kept_before = kept_topology_;
    Collapse collapse = judge(a, b, most_at_once(excess, goal.triangles, ends_));
    if (cost_of(queued.key()) < max_cost_) blocked_ += kept_topology_ - kept_before;
    if (pieces_ != nullptr && collapse.triangles == 4 && pieces_->is_left_over(a)) {
      collapse.cost *= k_cost_of_left_over;
    }
    if ((mesh_.flags[a] & k_opened) != 0) {
      collapse.cost *= k_loss_of_opened;
      collapse.certain *= k_loss_of_opened;
    }
    const double cost =
        collapse.triangles > excess ? cost_of_fewer(queued, collapse.cost, excess) : collapse.cost;
    if (collapse.triangles == 0) {
      refused_[a] = refused_[b] = 1;
    } else if (must_wait(queued, cost)) {
      remember_piece(queued, collapse.cost);
      wait(queued, cost);
      waited_ += by_general_ ? 0 : 1;  // no ranking knows how far a piece is from the rest
    } else if (!must_not_cross(queued, collapse) && !is_guarded(a, b, collapse)) {
      keep(goal);
      merge(a, b, collapse);
      if (progress && ++collapses % k_told_every == 0 && !progress(triangles_)) return Stop::told;
    }
  }
  return Stop::met;
}

/// What is remembered may be too little later, as pieces near this one go: the piece is judged
/// again before it goes.
void CollapseQueue::remember_piece(const QueuedEdge& queued, double cost) {
  if (!by_general_ || piece_ends_.empty()) return;
  for (const std::uint32_t v : general_.ends_of_piece()) {
    piece_ends_[v] = {cost, queued.a(), queued.b};
  }
}

double CollapseQueue::cost_of_piece(std::uint32_t a, std::uint32_t b) const {
  return piece_ends_.empty() ? 0 : std::min(piece_ends_[a].cost, piece_ends_[b].cost);
}

/// Whether another edge that would end the same piece is queued already. If none is, this one is
/// from now on.
bool CollapseQueue::is_queued_otherwise(const QueuedEdge& queued) {
  const std::uint32_t a = queued.a();
  const std::uint32_t b = queued.b;
  if (cost_of_piece(a, b) == 0) return false;
  for (const PieceEnd& end : {piece_ends_[a], piece_ends_[b]}) {
    if (end.b != 0) return end.a != a || end.b != b;
  }
  for (const std::uint32_t v : {a, b}) {
    piece_ends_[v].a = a;
    piece_ends_[v].b = b;
  }
  return false;
}

/// The cost of a collapse that leaves fewer triangles than the goal.
double CollapseQueue::cost_of_fewer(const QueuedEdge& queued, double cost,
                                    std::uint64_t excess) const {
  if (excess > 1) return cost * k_loss_of_fewer;
  const double squared = squared_length(mesh_.positions[queued.a()] - mesh_.positions[queued.b]);
  return std::max({cost * k_loss_of_one_fewer, max_cost_, k_nothing * squared * squared});
}

bool CollapseQueue::is_hopeless() const {
  const std::uint64_t blocked = blocked_ - blocked_before_;
  const std::uint64_t done = collapses_ - collapses_before_;
  return mesh_.stops_when_held && blocked > k_hopeless * done + k_edges_of_triangle * triangles_;
}

bool CollapseQueue::is_too_rough() const {
  const std::uint64_t done = collapses_ - collapses_before_;
  return !ranking_.is_refined() && waited_ > k_waits_of_rough * done + k_least_waits;
}

/// Whether the edge costs more than the goal allows, or more than both its rank and the next edge.
bool CollapseQueue::must_wait(const QueuedEdge& queued, double cost) const {
  if (cost > most_cost_) return true;
  const CostKey exact = key_of(cost);
  if (exact <= queued.key()) return false;
  const QueuedEdge* const other = next();
  return exact > limit_ || (other != nullptr && other->key() < exact);
}

/// Queues the edge again by its exact cost; beyond the goal's limit if it costs more than that.
void CollapseQueue::wait(const QueuedEdge& queued, double cost) {
  const CostKey least = cost > most_cost_ ? key_of(most_cost_) + 1 : 0;
  push({queued.a(), queued.b, std::max(key_of(cost), least)});
}

/// Called before each collapse: keeps a copy of the mesh if the next of the goal's counts is
/// reached.
void CollapseQueue::keep(const SimplifyGoal& goal) {
  bool is_due = false;
  for (; next_kept_ < goal.keep_at.size() && triangles_ <= goal.keep_at[next_kept_]; ++next_kept_) {
    is_due = true;
  }
  if (!is_due) return;
  std::erase_if(kept_, [&](const Mesh& mesh) {
    return static_cast<double>(mesh.triangles.size()) >
           k_far_more * static_cast<double>(triangles_);
  });
  std::vector<std::uint8_t> flags;
  copy_to(kept_.emplace_back(), flags, 0);
}

void CollapseQueue::count(const Collapse& collapse) {
  triangles_ -= collapse.triangles;
  max_cost_ = std::max(max_cost_, collapse.cost);
  last_cost_ = collapse.cost;
  const double certain = collapse.certain < 0 ? collapse.cost : collapse.certain;
  paid_ += certain;
  costs_.add(certain);
  ++collapses_;
}

/// Leaves a sheet of a closed piece; no vertices merge.
void CollapseQueue::open(const Collapse& collapse) {
  ring_.clear();
  for (const auto& [p, q, r] : general_.going()) {
    mesh_.adjacency.remove(p, {q, r});
    mesh_.adjacency.remove(q, {r, p});
    mesh_.adjacency.remove(r, {p, q});
    ring_.insert(ring_.end(), {p, q, r});
  }
  std::sort(ring_.begin(), ring_.end());
  ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
  count(collapse);
  for (const std::uint32_t v : ring_) {
    mesh_.flags[v] |= k_opened;
    stale_[v] = 1;
    classify(v);
  }
  if (mesh_.adjacency.has_uvs()) update_lines(ring_.front());
  for (const std::uint32_t v : ring_) look_again(v);
}

void CollapseQueue::merge(std::uint32_t a, std::uint32_t b, const Collapse& collapse) {
  if (collapse.opens) return open(collapse);
  if (guard_ != nullptr) guard_->merge();
  if (crossings_ != nullptr) crossings_->merge();
  const MergedColumns columns =
      by_general_ ? general_.columns_of(collapse) : judge_.columns_of(collapse);
  if (mesh_.adjacency.has_uvs()) {
    merge_wedges(columns.wedges, mesh_.adjacency.fan_at(a).ids, mesh_.adjacency.fan_at(b).ids,
                 mesh_.columns.uvs);
  }
  if (!past_.empty()) {
    past_[a] = past_[a].about(collapse.position - mesh_.positions[a]) +
               past_[b].about(collapse.position - mesh_.positions[b]);
  }
  join_stars(a, b);
  target_[b] = a;
  mesh_.flags[a] |= mesh_.flags[b];
  mesh_.positions[a] = collapse.position;
  if (!mesh_.appearances.empty()) mesh_.appearances[a] = columns.appearance;
  count(collapse);
  if (by_general_) tidy(a);
  list_ring(a);
  if (pieces_ != nullptr) {
    if (const auto four = pieces_->tetrahedron_at(a, mesh_.adjacency, mesh_.type)) move(*four);
  }
  if (mesh_.adjacency.has_uvs()) update_lines(a);
  ranking_.refresh(a);
  for (const std::uint32_t v : ring_) stale_[v] = 1;
  look_again(a);
  for (const std::uint32_t v : ring_) {
    if (refused_[v] != 0 && !may_be_left(v)) look_again(v);
  }
}

/// Whether too little has changed around a vertex to judge its refused edges again. Counts the
/// change.
bool CollapseQueue::may_be_left(std::uint32_t vertex) {
  if ((mesh_.flags[vertex] & k_complex) == 0) return false;
  // No edge of a hub can collapse, so its triangles are capped: the count of changes fits in a
  // byte.
  const std::uint32_t triangles = std::min(mesh_.adjacency.count(vertex), k_max_star);
  if (refused_[vertex] * k_complex_changes >= triangles) return false;
  ++refused_[vertex];
  return true;
}

/// A small chart goes with its last triangle, and with it the corners that only it made. Without
/// texture coordinates, such corners stay until the next pass.
void CollapseQueue::update_lines(std::uint32_t merged) {
  const auto update = [&](std::uint32_t v) {
    std::uint8_t& flags = mesh_.flags[v];
    if ((flags & k_crease) == 0) return;
    const std::uint8_t now =
        mesh_.creases.updated(v, mesh_.positions, mesh_.adjacency, mesh_.flags);
    if (now == flags) return;
    flags = now;
    refused_[v] = 1;  // will be judged again
  };
  update(merged);
  for (const std::uint32_t v : ring_) update(v);
}

void CollapseQueue::look_again(std::uint32_t vertex) {
  refused_[vertex] = 0;
  ++looks_[vertex];
  if (!piece_ends_.empty()) piece_ends_[vertex] = {};
  refresh(vertex);
  ranking_.for_edges_at(vertex, HUGE_VAL, [&](const RankedEdge& edge) { push(edge); });
}

}  // namespace meshfarm
