// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify_sweep.hpp"

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

}  // namespace

std::uint32_t Sweep::partner(std::uint32_t vertex) const {
  const CollapseState& state = state_.collapse;
  const std::uint8_t flags = state.flags[vertex];
  const std::span<const Corner> fan = state.adjacency->at(vertex);
  if ((flags & k_fixed) != 0 || fan.size() > k_max_star) return vertex;
  const Vec3 at = state.positions[vertex];
  double least = HUGE_VAL;
  std::uint32_t nearest = vertex;
  const auto consider = [&](std::uint32_t neighbour, std::uint8_t barred) {
    const std::uint32_t end = state.target[neighbour];
    const double squared = squared_length(state.positions[end] - at);
    const bool allowed = ((state.flags[end] & (k_fixed | barred)) | state_.touched[end]) == 0;
    const bool nearer = allowed & (squared < least);
    least = nearer ? squared : least;
    nearest = nearer ? end : nearest;
  };
  const bool border = (flags & k_border) != 0;
  for (const Corner& c : fan) consider(c.next, border ? k_border : 0);
  if (border) {
    for_border_edges(fan, [&](const Corner&, std::uint32_t end) { consider(end, 0); });
  }
  return nearest;
}

std::optional<double> Sweep::estimate_limit(CollapseJudge& judge, double share) const {
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
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(costs.size() - 1));
  std::nth_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(rank), costs.end());
  return costs[rank];
}

}  // namespace meshfarm
