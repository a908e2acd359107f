// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/quotas.hpp"

#include <algorithm>
#include <cstddef>

namespace meshfarm {
namespace {

/// From a piece that reached its quota, at most the quota divided by this is taken again.
constexpr std::uint64_t k_least_kept = 2;  // half

std::uint64_t sum_at(std::span<const PieceWeight> pieces, std::int32_t step) {
  std::uint64_t sum = 0;
  for (const PieceWeight& each : pieces) sum += each.at(step);
  return sum;
}

/// Numbers of the pieces, largest first.
std::vector<std::size_t> by_size(std::span<const std::uint64_t> quotas) {
  std::vector<std::size_t> order(quotas.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return quotas[a] > quotas[b]; });
  return order;
}

std::uint64_t even(std::uint64_t count) {
  return count & ~std::uint64_t{1};
}

}  // namespace

std::int32_t step_below(std::span<const PieceWeight> pieces, std::uint64_t target) {
  std::int32_t first = pieces.front().first_step;
  std::int32_t last = first;
  for (const PieceWeight& each : pieces) {
    first = std::min(first, each.first_step);
    last = std::max(last, each.first_step + static_cast<std::int32_t>(each.counts.size()) - 1);
  }
  while (first < last && sum_at(pieces, first) > target) ++first;
  return first;
}

std::vector<std::uint64_t> share_out_triangles(std::span<const PieceWeight> pieces,
                                               std::uint64_t target) {
  std::vector<std::uint64_t> quotas;
  std::uint64_t sum = 0;
  for (const PieceWeight& each : pieces) sum += each.before;
  if (pieces.empty() || sum <= target) {
    for (const PieceWeight& each : pieces) quotas.push_back(each.before);
    return quotas;
  }
  const std::int32_t step = step_below(pieces, target);
  const std::uint64_t above = std::max(target, sum_at(pieces, step - 1));
  const std::uint64_t below = std::min(target, sum_at(pieces, step));
  // If even the last step leaves too many, all give the same share of what they have.
  const bool is_between = sum_at(pieces, step) <= target;
  const double share =
      is_between ? static_cast<double>(above - target) /
                       static_cast<double>(std::max<std::uint64_t>(1, above - below))
                 : 1 - static_cast<double>(target) / static_cast<double>(sum_at(pieces, step));
  std::uint64_t all = 0;
  for (const PieceWeight& each : pieces) {
    const std::uint64_t most = is_between ? each.at(step - 1) : each.at(step);
    const std::uint64_t range = is_between ? most - each.at(step) : most;
    const auto gives = static_cast<std::uint64_t>(share * static_cast<double>(range));
    quotas.push_back(each.before - even(each.before - (most - gives)));
    all += quotas.back();
  }
  // Rounding left too many triangles: at most two per piece.
  for (const std::size_t i : by_size(quotas)) {
    if (all <= target + 1) break;
    const std::uint64_t taken = std::min(even(all - target), even(quotas[i]));
    const std::uint64_t fair =
        std::min<std::uint64_t>(taken, 2 + 2 * (all - target) / pieces.size());
    quotas[i] -= even(fair);
    all -= even(fair);
  }
  if (all == target) return quotas;
  const auto odd = std::find_if(pieces.begin(), pieces.end(),
                                [](const PieceWeight& each) { return each.can_be_odd(); });
  const auto i = odd == pieces.end() ? by_size(quotas).front()
                                     : static_cast<std::size_t>(odd - pieces.begin());
  if (all > target) quotas[i] -= std::min<std::uint64_t>(quotas[i], odd == pieces.end() ? 2 : 1);
  return quotas;
}

std::vector<std::uint64_t> share_out_again(std::span<const PieceWeight> pieces,
                                           std::span<const std::uint64_t> quotas,
                                           std::span<const std::uint64_t> made) {
  std::uint64_t excess = 0;
  for (std::size_t i = 0; i < made.size(); ++i) excess += made[i] - std::min(made[i], quotas[i]);
  std::vector<std::uint64_t> again(quotas.begin(), quotas.end());
  for (const std::size_t i : by_size(made)) {
    if (excess == 0) break;
    if (made[i] > quotas[i]) continue;
    std::uint64_t taken = std::min(excess + excess % 2, even(quotas[i] / k_least_kept));
    if (excess % 2 != 0 && pieces[i].can_be_odd() && taken > excess) taken = excess;
    again[i] -= taken;
    excess -= std::min(excess, taken);
  }
  // If an open border can't change, the last triangle goes together with another one.
  for (std::size_t i = 0; i < made.size() && excess > 0; ++i) {
    if (made[i] != quotas[i] + 1 || quotas[i] == 0) continue;
    --again[i];
    --excess;
  }
  return excess == 0 ? again : std::vector<std::uint64_t>();
}

}  // namespace meshfarm
