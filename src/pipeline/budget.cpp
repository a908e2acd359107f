// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>

namespace meshfarm {
namespace {

/// Points of the input by which the error of the result is measured: the RMS of as many varies by
/// less than one per cent.
constexpr std::uint64_t k_error_samples = 100'000;
/// A bound is on the greatest distance, which more points find more of, vertices most.
constexpr std::uint64_t k_bound_samples = 200'000;

}  // namespace

double provision(double ratio) {
  return 1 + std::min(1.0, (1 - ratio) / (4 * ratio));
}

std::uint64_t samples_for(const Manifest& manifest, const RunOptions& options,
                          std::uint64_t triangles) {
  const double share = static_cast<double>(triangles) /
                       static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles()));
  return static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(all_samples(options))));
}

std::uint64_t all_samples(const RunOptions& options) {
  return options.error.value > 0 ? k_bound_samples : k_error_samples;
}

double refused_by(const Rung& rung, double free_triangles) {
  const double times = static_cast<double>(rung.free_triangles) / std::max(1.0, free_triangles);
  return static_cast<double>(rung.refused) * times * times * times * times;
}

std::uint32_t rung_at(std::span<const Rung> ladder, std::int32_t level) {
  std::uint32_t rung = 0;
  while (rung + 1 < ladder.size() && ladder[rung + 1].level <= level) ++rung;
  return rung;
}

std::uint64_t free_triangles_at(const ResultSummary& part, std::int32_t level) {
  const Rung& rung = part.rungs[rung_at(part.rungs, level)];
  if (!part.goes_on() || level <= part.rungs.back().level) return rung.free_triangles;
  auto left = static_cast<double>(rung.free_triangles);
  for (std::int32_t below = rung.level; below < level; ++below) left /= k_level_step;
  return static_cast<std::uint64_t>(left);
}

std::uint64_t free_triangles_at(std::span<const ResultSummary> parts, std::int32_t level) {
  std::uint64_t free = 0;
  for (const ResultSummary& part : parts) free += free_triangles_at(part, level);
  return free;
}

std::int32_t common_level(std::span<const ResultSummary> parts, std::uint64_t wanted) {
  std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
  std::int32_t highest = std::numeric_limits<std::int32_t>::min();
  for (const ResultSummary& part : parts) {
    lowest = std::min(lowest, part.rungs.front().level);
    highest = std::max(highest, part.rungs.back().level);
  }
  for (std::int32_t level = highest; level > lowest; --level) {
    if (free_triangles_at(parts, level) >= wanted) return level;
  }
  return lowest;
}

}  // namespace meshfarm
