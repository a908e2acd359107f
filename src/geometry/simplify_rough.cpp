// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify_rough.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/simplify_clean.hpp"
#include "geometry/simplify_rank.hpp"

namespace meshfarm {
namespace {

// Gives the rank to one or two per cent.
constexpr std::uint32_t k_sampled_vertices = 2048;
constexpr std::size_t k_least_sample = 128;
// With fewer vertices that merge a pass is not worth its time.
constexpr double k_least_share = 0.3;

}  // namespace

std::uint32_t RoughPass::partner(std::uint32_t vertex) const {
  const CollapseState& state = state_.collapse;
  const std::uint8_t flags = state.flags[vertex];
  const std::span<const Corner> fan = state.adjacency->at(vertex);
  if ((flags & k_still) != 0 || fan.size() > k_max_star) return vertex;
  const Vec3 at = state.positions[vertex];
  double least = HUGE_VAL;
  std::uint32_t nearest = vertex;
  const auto consider = [&](std::uint32_t neighbour, std::uint8_t barred) {
    const std::uint32_t end = state.target[neighbour];
    const double squared = squared_length(state.positions[end] - at);
    const bool allowed = ((state.flags[end] & (k_still | barred)) | state_.touched[end]) == 0;
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
    for_crease_edges(fan, at, state.positions, *state.creases, is_on_crease,
                     [&](const Corner& one, const Corner&) { consider(one.prev, barred); });
  }
  return nearest;
}

std::optional<double> RoughPass::estimate_limit(CollapseJudge& judge, double share,
                                                double most) const {
  const auto vertices = static_cast<std::uint32_t>(state_.collapse.positions.size());
  const std::uint32_t one_in = std::max(1U, vertices / k_sampled_vertices);
  const CollapseLimits no_limits{UINT64_MAX, HUGE_VAL};
  std::vector<double> costs;
  for (std::uint32_t first = 0; vertices - first >= one_in; first += one_in) {
    const std::uint32_t vertex = first + scrambled(first) % one_in;
    const std::uint32_t other = partner(vertex);
    if (other == vertex) continue;
    const Collapse collapse =
        judge.judge(std::min(vertex, other), std::max(vertex, other), no_limits);
    if (collapse.triangles > 0) costs.push_back(collapse.cost);
  }
  if (costs.size() < k_least_sample) return {};
  const auto can = std::count_if(costs.begin(), costs.end(), [&](double c) { return c <= most; });
  if (static_cast<double>(can) < k_least_share * static_cast<double>(costs.size())) return {};
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(costs.size() - 1));
  std::nth_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(rank), costs.end());
  return std::min(costs[rank], most);
}

}  // namespace meshfarm
