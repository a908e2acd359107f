// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>

namespace meshfarm {
namespace {

/// Points of the input to measure the error of the result by: the RMS of this many varies by less
/// than one per cent.
constexpr std::uint64_t k_error_samples = 100'000;
/// A bound limits the maximum, which more points find better, vertices best.
constexpr std::uint64_t k_bound_samples = 200'000;

/// Points per triangle of the result to fit its vertices: with fewer the result hardly gets nearer,
/// and more are useless.
constexpr std::uint64_t k_least_fit_points = 4;
constexpr std::uint64_t k_enough_fit_points = 20;
/// More than the minimum are used only up to this total.
constexpr std::uint64_t k_plenty_of_fit_points = 300'000;
/// About a second of processor time.
constexpr std::uint64_t k_most_automatic_fit_points = 500'000;
/// In memory, at up to 90 bytes each.
constexpr std::uint64_t k_most_fit_points = 8'000'000;

}  // namespace

double provision(double ratio) {
  return 1 + std::min(1.0, (1 - ratio) / (4 * ratio));
}

std::uint64_t samples_for(const Manifest& manifest, const RunOptions& options,
                          std::uint64_t triangles) {
  const double share = static_cast<double>(triangles) /
                       static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles()));
  return static_cast<std::uint64_t>(
      std::ceil(share * static_cast<double>(sample_counts(manifest, options).all())));
}

std::string why_not_fitted(const RunOptions& options) {
  if (options.error.value > 0) return "--error: a bound decides where vertices are";
  if (options.lines.crossings == CrossingMode::avoid) {
    return "--crossings avoid: what was seen to cross nothing stays";
  }
  if (options.finish == Finish::boundary) return "--finish boundary: only edges at seams change";
  if (options.drop_components.value > 0) {
    return "--drop-components: points of what is left out would count";
  }
  return {};
}

SampleCounts sample_counts(const Manifest& manifest, const RunOptions& options) {
  if (options.error.value > 0) return {k_bound_samples, 0};
  SampleCounts counts{k_error_samples, 0};
  if (options.fit == VertexFit::off || !why_not_fitted(options).empty()) return counts;
  // Uses the full input, as jobs that cut it do not know what is left of it.
  const std::uint64_t input = manifest.input_triangles;
  const double share = options.ratio * static_cast<double>(input);
  const std::uint64_t triangles =
      std::min(input, options.triangles != 0 ? options.triangles
                                             : static_cast<std::uint64_t>(std::llround(share)));
  const std::uint64_t least = k_least_fit_points * triangles;
  const bool is_asked = options.fit == VertexFit::on;
  if (least > (is_asked ? k_most_fit_points : k_most_automatic_fit_points)) return counts;
  counts.fitting =
      std::min(k_enough_fit_points * triangles, std::max(k_plenty_of_fit_points, least));
  return counts;
}

SplitSamples split_samples(std::vector<SurfaceSamples> all, const SampleCounts& counts) {
  if (counts.fitting == 0) return {std::move(all), {}};
  SplitSamples split;
  const double share = static_cast<double>(counts.measured) / static_cast<double>(counts.all());
  for (SurfaceSamples& set : all) {
    SurfaceSamples& measured = split.measured.emplace_back(SurfaceSamples{set.area, {}});
    SurfaceSamples& fitting = split.fitting.emplace_back(SurfaceSamples{set.area, {}});
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      const auto place = static_cast<double>(i);
      const bool is_measured =
          i == 0 || std::floor(place * share) > std::floor((place - 1) * share);
      (is_measured ? measured : fitting).points.push_back(set.points[i]);
    }
    set.points = {};
  }
  return split;
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
