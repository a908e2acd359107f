// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/rough_pass.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/simplify/simplify_rank.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

// A rough pass needs more than this many times the triangles of the last goal, and more than
// k_far_of_step times those of this step's goal. Used only down to 8 times the last goal, they took
// 10 % longer for 1 % less error.
constexpr std::uint64_t k_far_rank = 4;
constexpr std::uint64_t k_far_of_step = 2;
constexpr std::uint32_t k_least_vertices = 8192;

// A rough pass merges no more than this share of the vertices, and spares at least as many of the
// most expensive ones as the goal leaves.
constexpr double k_most_rough = 0.97;
// No vertex merges that costs more than this many times the median of those that do. A model of 8
// boxes and 260 finely tessellated pieces, which have all but 3 % of the vertices, lost the boxes'
// shape first.
constexpr double k_most_above_half = 65'536;
// The limit also stays this factor below the goal's own, near which the order matters.
constexpr double k_rough_margin = 8;

// Sample size: determines the rank to one or two per cent.
constexpr std::uint32_t k_rough_vertices = 2048;
constexpr std::size_t k_least_rough_sample = 128;
// If less than this share of the vertices can merge, a pass is not worth its time.
constexpr double k_least_rough_share = 0.3;
// At one sampled vertex in this many, check whether another edge than the shortest would cost less.
constexpr std::size_t k_looked_round = 8;
// Maximum ratio of the total cost of the shortest edges to that of the cheapest ones. Above it, the
// surface needs long triangles: along tubes, folds and blades. What rough passes spoil there,
// ranked ones do not mend. Scans, noise and most CT have 1.1 to 2; a turbine's blade and a ship's
// hull 2 to 3, which with a limit of 4 have 20 % more error; tubes 5 and more as long as there are
// many triangles around them.
constexpr double k_most_dearer = 2;
// The same ratio per vertex, which at most a quarter of them may exceed: expensive edges may hide
// others. On a circuit board, whose pieces are much more expensive than the rest, all shortest
// edges together cost 1.1 times as much as the cheapest, but a quarter of them 140 times or more.
// On scans, a quarter cost 2 to 7 times or more.
constexpr double k_most_dearer_of_quarter = 16;

/// The costs of merging a vertex along its shortest edge, and along its cheapest.
struct MergeCosts {
  double shortest = 0;
  double cheapest = 0;
};

/// Whether the shortest edges within the limit are good enough: in total, and for all but a quarter
/// of them.
bool are_shortest_good(std::span<const MergeCosts> costs, double limit) {
  MergeCosts sum;
  std::size_t count = 0;
  std::size_t much_dearer = 0;
  for (const MergeCosts& each : costs) {
    if (each.shortest > limit) continue;
    sum.shortest += each.shortest;
    sum.cheapest += each.cheapest;
    ++count;
    much_dearer += each.shortest > k_most_dearer_of_quarter * each.cheapest ? 1 : 0;
  }
  return sum.shortest <= k_most_dearer * sum.cheapest && 4 * much_dearer <= count;
}

double cost_at(std::vector<double>& costs, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(costs.size() - 1));
  std::nth_element(costs.begin(), costs.begin() + rank, costs.end());
  return costs[static_cast<std::size_t>(rank)];
}

}  // namespace

bool RoughPass::is_worth_it(const WorkingMesh& mesh, const SimplifyGoal& goal) {
  return mesh.triangles() > k_far_rank * last_of(goal) &&
         mesh.triangles() > k_far_of_step * goal.triangles && mesh.vertices() > k_least_vertices;
}

std::uint64_t RoughPass::run(const SimplifyGoal& goal) {
  mesh_.begin_pass();
  const std::span<const std::uint8_t> touched = mesh_.touched();
  CollapseJudge judge(mesh_.state());
  const RoughPartners partners(mesh_.state(), touched);
  const std::uint64_t excess = mesh_.triangles() - goal.triangles;
  const double left = static_cast<double>(last_of(goal)) / static_cast<double>(mesh_.triangles());
  const std::optional<double> limit = partners.estimate_limit(
      judge, std::min(k_most_rough, 1 - left), goal.max_cost / k_rough_margin);
  CollapseLimits limits{excess, limit.value_or(0)};
  for (std::uint32_t v = 0; limit && v < touched.size() && limits.triangles > 1; ++v) {
    if (touched[v] != 0) continue;
    const std::uint32_t other = partners.of(v);
    if (other == v) continue;
    const auto [a, b] = std::minmax(v, other);
    const Collapse collapse = judge.judge(a, b, limits);
    if (collapse.triangles == 0) continue;
    mesh_.merge(a, b, collapse, judge.columns_of(collapse));
    limits.triangles -= collapse.triangles;
  }
  const std::uint64_t removed = excess - limits.triangles;
  mesh_.end_pass(removed, limit.value_or(mesh_.pass_cost()));
  return removed;
}

std::uint32_t RoughPartners::of(std::uint32_t vertex) const {
  const CollapseState& state = state_;
  const std::uint8_t flags = state.flags[vertex];
  const std::span<const Corner> fan = state.adjacency->at(vertex);
  if ((flags & k_still) != 0 || fan.size() > k_max_star) return vertex;
  const Vec3 at = state.positions[vertex];
  double least = HUGE_VAL;
  std::uint32_t nearest = vertex;
  const auto consider = [&](std::uint32_t neighbour, std::uint8_t barred) {
    const std::uint32_t end = state.target[neighbour];
    const double squared = squared_length(state.positions[end] - at);
    const bool allowed = ((state.flags[end] & (k_still | barred)) | touched_[end]) == 0;
    const bool nearer = allowed & (squared < least);
    least = nearer ? squared : least;
    nearest = nearer ? end : nearest;
  };
  for (const Corner& c : fan) consider(c.next, barred_beside(flags));
  const std::uint8_t barred = barred_along(flags);
  if ((flags & k_border) != 0) {
    for_border_edges(fan, [&](const Corner&, std::uint32_t end) { consider(end, barred); });
  }
  if ((flags & k_crease) != 0) {
    const auto is_on_crease = [&](std::uint32_t end) { return (state.flags[end] & k_crease) != 0; };
    for_crease_edges(state.adjacency->fan_at(vertex), at, state.positions, *state.creases,
                     is_on_crease,
                     [&](const Corner& one, const Corner&, bool) { consider(one.prev, barred); });
  }
  return nearest;
}

std::optional<double> RoughPartners::estimate_limit(CollapseJudge& judge, double share,
                                                    double most) const {
  const auto vertices = static_cast<std::uint32_t>(state_.positions.size());
  const std::uint32_t one_in = std::max(1U, vertices / k_rough_vertices);
  const CollapseLimits no_limits{UINT64_MAX, HUGE_VAL};
  std::vector<double> costs;
  std::vector<MergeCosts> compared;  // of some of them
  for (std::uint32_t first = 0; vertices - first >= one_in; first += one_in) {
    const std::uint32_t vertex = first + scrambled(first) % one_in;
    const std::uint32_t other = of(vertex);
    if (other == vertex) continue;
    const Collapse collapse =
        judge.judge(std::min(vertex, other), std::max(vertex, other), no_limits);
    if (collapse.triangles == 0) continue;
    if (costs.size() % k_looked_round == 0) {
      compared.push_back({collapse.cost, std::min(collapse.cost, cheapest_at(vertex, judge))});
    }
    costs.push_back(collapse.cost);
  }
  if (costs.size() < k_least_rough_sample) return {};
  const auto can = std::count_if(costs.begin(), costs.end(), [&](double c) { return c <= most; });
  if (static_cast<double>(can) < k_least_rough_share * static_cast<double>(costs.size())) return {};
  const double limit =
      std::min({most, cost_at(costs, share), k_most_above_half * cost_at(costs, share / 2)});
  if (!are_shortest_good(compared, limit)) return {};
  return limit;
}

double RoughPartners::cheapest_at(std::uint32_t vertex, CollapseJudge& judge) const {
  double least = HUGE_VAL;
  for (const Corner& c : state_.adjacency->at(vertex)) {
    const std::uint32_t end = state_.target[c.next];
    if (end == vertex) continue;
    const auto [a, b] = std::minmax(vertex, end);
    const Collapse collapse = judge.judge(a, b, {UINT64_MAX, least});
    if (collapse.triangles > 0) least = std::min(least, collapse.cost);
  }
  return least;
}

}  // namespace meshfarm
