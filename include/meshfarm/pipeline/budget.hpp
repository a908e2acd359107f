// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// The finish keeps to this share of a bound on the error: between the points that it checks, a
/// surface may be a little farther away.
inline constexpr double k_bound_share = 0.92;
/// Parts keep to this smaller share, as the finish also checks other points of them.
inline constexpr double k_bound_share_of_parts = 0.9;

/// The accepted result of a part or of composed streams, and the rung of it to stitch.
struct ChosenRung {
  FileRef file;
  std::uint32_t rung = 0;
  std::uint32_t parts = 1;               // number of parts in it
  std::uint64_t dropped_degenerate = 0;  // in the part
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
  RungPlace place = {};
};

/// What to stitch, in the order of the parts, and how to finish it.
struct ChosenRungs {
  std::vector<ChosenRung> rungs;
  /// The same from a finer level that holds `times_finer` times as many free triangles, a fifth
  /// more or slightly above that; empty if the ladders have no such level.
  std::vector<ChosenRung> finer;
  double times_finer = 1;
  /// Results with the topology of the input: the rungs, if the parts kept it; else those climbed
  /// before that kept it; empty if there were none.
  std::vector<ChosenRung> kept;
  TopologyMode topology = TopologyMode::automatic;
};

/// How many times the target the parts together keep for the finish to choose from: twice if much
/// is simplified away (measured: more is no better), less if little is, as there are few seams
/// then.
double provision(double ratio);

/// The number of points, for all purposes, to sample from a surface of `triangles` of the input's
/// triangles.
std::uint64_t samples_for(const Manifest& manifest, const RunOptions& options,
                          std::uint64_t triangles);

/// Points sampled from the whole surface: some to measure the error by, others to fit the result's
/// vertices to. The points of a fit can't measure it: the vertices are near them by construction.
struct SampleCounts {
  std::uint64_t measured = 0;
  std::uint64_t fitting = 0;  // 0: the vertices stay where they are
  std::uint64_t all() const { return measured + fitting; }
};
/// The option that prevents fitting vertices, and why; empty if they may be fitted.
std::string why_not_fitted(const RunOptions& options);
SampleCounts sample_counts(const Manifest& manifest, const RunOptions& options);

/// The points sampled for both purposes.
struct SplitSamples {
  std::vector<SurfaceSamples> measured;
  std::vector<SurfaceSamples> fitting;  // empty if no vertices are to be fitted
};
/// Splits the points of each set, evenly along it.
SplitSamples split_samples(std::vector<SurfaceSamples> all, const SampleCounts& counts);

/// How many collapses will have been refused to keep the topology once this many free triangles are
/// left, extrapolated from a rung: refusals per triangle rise with about the fourth power of the
/// reduction.
double refused_by(const Rung& rung, double free_triangles);

/// The coarsest rung of a ladder that is not above `level`; if there is none, the first.
std::uint32_t rung_at(std::span<const Rung> ladder, std::int32_t level);

/// Free triangles of a part at a level. Beyond the end of a ladder that goes on, the number that a
/// smooth surface would have.
std::uint64_t free_triangles_at(const ResultSummary& part, std::int32_t level);
/// The sum over all parts.
std::uint64_t free_triangles_at(std::span<const ResultSummary> parts, std::int32_t level);

/// The coarsest level at which the parts together still hold `wanted` free triangles; the finest
/// level if none does.
std::int32_t common_level(std::span<const ResultSummary> parts, std::uint64_t wanted);

}  // namespace meshfarm
