// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/ranked_passes.hpp"

#include <algorithm>
#include <cmath>

namespace meshfarm {
namespace {

// Only this share of the edges, the cheapest, is taken before all are ranked again. With 0.25 or
// 0.3 the error is the same; with 0.5 it is 2 to 4 % more for 10 % less time.
constexpr double k_pass_share = 0.35;

// Above this many times the triangles of the goal, more may be taken at once: the error is made
// later. From 4 times on, it is 1 % more at a tenth of the triangles.
constexpr std::uint64_t k_far = 8;
constexpr double k_far_share = 0.5;

// If a pass removes less than this share of the triangles, most edges that it ranks are refused.
// Refused cheap edges must not make room for expensive ones: the rest is done in order.
constexpr double k_least_ranked = 0.05;

// A pass in order of cost ends where more than this many edges more were refused for the topology
// than collapsed, and the next costs more than k_far_dearer times what these do. Folds of thin
// sheets are refused at a millionth of the cost of what would be taken instead.
constexpr std::uint64_t k_few_refused = 16;
constexpr double k_far_dearer = 8;

// At this many times the triangles of the last goal, edges begin to collapse strictly in order; for
// a large goal at k_near_of_large times, unless passes reach a dead end.
constexpr std::uint64_t k_near = 2;
constexpr double k_near_of_large = 1.25;
constexpr std::uint64_t k_large = 50'000;

// Topology refusals, as a share of the collapses. On smooth surfaces it is one in a thousand.
constexpr double k_slowed = 0.01;

// Refusals in a pass, as a share of the triangles. Below it, the cheap edges that are left are not
// worth an ordered run, which takes long above this many triangles. With 10,000, a body model has
// 2 % more error.
constexpr double k_little_refused = 0.01;
constexpr std::uint64_t k_too_many_to_order = 25'000;

// The passes end when the bound may be near for more than this many edges per collapse.
constexpr double k_bounded = 0.2;
// Until then, drifts at a vertex add up to at most this share of the bound.
constexpr double k_drift_share = 0.4;
// Minimum drift counted for a collapse, as a share of the bound.
constexpr double k_least_drift = 0.02;

// Edges taken in a pass that must not overshoot, as a share of the triangles still to go: about six
// in ten can collapse, and each of these removes two.
constexpr double k_most_of_excess = 0.7;

// Vertices whose edges are ranked, sorted and collapsed together: they and their stars fit into a
// core's cache. On 10M triangles this halves the time.
constexpr std::uint32_t k_block = 4096;

}  // namespace

RankedPasses::RankedPasses(WorkingMesh& mesh, const SurfaceBound* bound)
    : mesh_(mesh), bound_(bound), drifts_(bound != nullptr ? mesh.vertices() : 0, 0) {}

RankedPasses::End RankedPasses::reduce(const SimplifyGoal& goal,
                                       const std::function<bool(std::uint64_t)>& progress) {
  all_collapses_ = all_refused_for_topology_ = 0;
  while (mesh_.is_above(goal) && !is_near(goal)) {
    mesh_.begin_pass();
    ranking_.begin_pass({mesh_.mesh().positions, mesh_.mesh().triangles, mesh_.flags(),
                         &mesh_.adjacency(), &mesh_.creases().test(), mesh_.seam_only(), false,
                         false, ranks_by_bounds_, mesh_.mesh().appearances,
                         mesh_.appearance_scale(), mesh_.uv_scale()});
    if (ranks_finely_) ranking_.refine();
    const Pass pass = plan(goal);
    const std::uint64_t before = mesh_.triangles();
    const std::uint64_t removed = run(goal, pass);
    all_collapses_ += collapses_;
    all_refused_for_topology_ += refused_for_topology_;
    if (progress && !progress(mesh_.triangles())) return End::told;
    if (!mesh_.is_above(goal)) break;  // however little there was to do
    const bool is_little =
        static_cast<double>(removed) < k_least_ranked * static_cast<double>(before);
    if (is_little && is_too_rough(goal, pass)) {
      ranks_finely_ = true;
      continue;
    }
    // Cheap edges are refused: expensive ones must not be taken instead.
    if (refused_for_topology_ > collapses_) return End::dead_end;
    if (static_cast<double>(refused_for_bound_) > k_bounded * static_cast<double>(collapses_)) {
      return End::near;
    }
    if (is_little) {
      if (ranks_by_bounds_ && goal.max_cost > cost_of(pass.limit)) {
        ranks_by_bounds_ = ranks_finely_ = false;
        continue;
      }
      return goal.max_cost <= cost_of(pass.limit) ? End::exhausted : End::dead_end;
    }
  }
  return End::near;
}

/// Whether most edges that rank low turned out to cost more than they ranked by.
bool RankedPasses::is_too_rough(const SimplifyGoal& goal, const Pass& pass) const {
  const std::uint64_t too_dear = tried_ - collapses_ - refused_for_topology_;
  return ranks_by_bounds_ && !ranks_finely_ && 2 * too_dear > tried_ &&
         goal.max_cost > cost_of(pass.limit);
}

bool RankedPasses::is_slowed_by_topology() const {
  return static_cast<double>(all_refused_for_topology_) >
         k_slowed * static_cast<double>(all_collapses_);
}

bool RankedPasses::refuses_little() const {
  const std::uint64_t left = mesh_.triangles();
  return left > k_too_many_to_order &&
         static_cast<double>(tried_ - collapses_) <= k_little_refused * static_cast<double>(left);
}

bool RankedPasses::is_near(const SimplifyGoal& goal) const {
  const std::uint64_t last = last_of(goal);
  const auto of_large = static_cast<std::uint64_t>(k_near_of_large * static_cast<double>(last));
  return mesh_.triangles() <= std::min(k_near * last, std::max(of_large, last + k_large));
}

/// Far from the goal passes go block by block and take too few edges to overshoot it; the last
/// ones take the cheapest edges of the whole mesh first, and stop at the goal.
RankedPasses::Pass RankedPasses::plan(const SimplifyGoal& goal) {
  const std::uint64_t triangles = mesh_.triangles();
  const std::uint64_t excess = triangles - goal.triangles;
  const std::uint32_t vertices = mesh_.vertices();
  double share = k_pass_share;
  if (triangles > k_far * goal.triangles) share = std::max(share, k_far_share);
  const bool far = excess > triangles / 8 && vertices > 2 * k_block;
  Pass pass;
  pass.block = far ? k_block : vertices;
  const double most = far ? k_most_of_excess * static_cast<double>(excess) : HUGE_VAL;
  pass.limit = ranking_.estimate_limit(share, most);
  pass.max_cost = std::min(goal.max_cost, cost_of(pass.limit));
  return pass;
}

/// Returns the number of triangles removed. A pass through the whole mesh that stops at the goal
/// may have paid less than its limit.
std::uint64_t RankedPasses::run(const SimplifyGoal& goal, const Pass& pass) {
  const std::uint32_t vertices = mesh_.vertices();
  const std::span<const std::uint8_t> touched = mesh_.touched();
  CollapseJudge judge(mesh_.state());
  const std::uint64_t excess = mesh_.triangles() - goal.triangles;
  CollapseLimits limits{excess, pass.max_cost};
  double reached = pass.max_cost;
  DriftMeter drifts(mesh_.state());
  CrossingGuard guard;
  if (mesh_.avoids_crossings()) {
    guard.start(mesh_.state(), mesh_.mesh().triangles, CrossingGuard::Where::thin_walls);
  }
  tried_ = collapses_ = refused_for_topology_ = refused_for_bound_ = 0;
  const bool in_order = pass.block == vertices;
  double refused_at = HUGE_VAL;  // the cost from which on most were refused
  const auto is_far_dearer = [&](double cost) {
    if (refused_for_topology_ <= collapses_ + k_few_refused) return false;
    refused_at = std::min(refused_at, std::max(cost, mesh_.max_cost()));
    return cost > k_far_dearer * refused_at;
  };
  for (std::uint32_t first = 0; first < vertices && limits.triangles > 0; first += pass.block) {
    const std::uint32_t last = std::min(vertices, first + pass.block);
    for (const RankedEdge& e : ranking_.cheapest(first, last, {pass.limit, pass.max_cost})) {
      if ((touched[e.a] | touched[e.b]) != 0) continue;
      if (in_order && is_far_dearer(cost_of(e.key))) {
        reached = std::min(reached, refused_at);
        break;
      }
      ++tried_;
      const Collapse collapse = judge.judge(e.a, e.b, limits);
      refused_for_topology_ += collapse.by_topology ? 1 : 0;
      if (collapse.triangles == 0) continue;
      const bool is_guarded = mesh_.avoids_crossings() && guard.concerns(e.a, e.b);
      if (is_guarded && guard.crosses({e.a, e.b, collapse.position, {}})) continue;
      if (!may_drift(drifts, e, collapse)) continue;
      if (is_guarded) guard.merge();
      ++collapses_;
      mesh_.merge(e.a, e.b, collapse, judge.columns_of(collapse));
      limits.triangles -= collapse.triangles;
      if (limits.triangles <= 1 && in_order) reached = std::min(reached, cost_of(e.key));
      if (limits.triangles == 0) break;
    }
  }
  double paid = std::isfinite(reached) ? reached : mesh_.max_cost();
  // What is refused may rank as if it cost nothing.
  if (refused_for_topology_ > collapses_) paid = std::max(paid, mesh_.pass_cost());
  const std::uint64_t removed = excess - limits.triangles;
  mesh_.end_pass(removed, paid);
  if (removed > 0) renumber_drifts();
  return removed;
}

/// Whether there is no bound, or it is far off. If so, the collapse must be done.
bool RankedPasses::may_drift(DriftMeter& meter, const RankedEdge& edge, const Collapse& collapse) {
  if (bound_ == nullptr) return true;
  const double least = k_least_drift * bound_->distance();
  const double drift = meter.drift_of(edge.a, edge.b, collapse.position, least) +
                       std::max(drifts_[edge.a], drifts_[edge.b]);
  if (!(drift <= k_drift_share * bound_->distance())) {
    ++refused_for_bound_;
    return false;
  }
  drifts_[edge.a] = static_cast<float>(drift);
  return true;
}

void RankedPasses::renumber_drifts() {
  const std::span<const std::uint32_t> numbers = mesh_.numbers();
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < drifts_.size(); ++v) {
    if (numbers[v] == kept) drifts_[kept++] = drifts_[v];
  }
  drifts_.resize(kept);
}

}  // namespace meshfarm
