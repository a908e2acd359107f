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

/// Of a bound on the error parts and finish keep to this share: between the points that they look
/// at a surface may be a little farther.
inline constexpr double k_bound_share = 0.92;
/// And parts, as the finish looks at other points of them, to this.
inline constexpr double k_bound_share_of_parts = 0.9;

/// The result of a part, or of composed streams, that counts, and the rung to stitch.
struct ChosenRung {
  FileRef file;
  std::uint32_t rung = 0;
  std::uint32_t parts = 1;               // that it holds
  std::uint64_t dropped_degenerate = 0;  // in the part
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
  RungPlace place = {};
};

/// What to stitch, in the order of the parts, and how to finish it.
struct ChosenRungs {
  std::vector<ChosenRung> rungs;
  /// The same from a finer level that holds so many times the free triangles, a fifth more or
  /// somewhat above; none if the ladders have no such level.
  std::vector<ChosenRung> finer;
  double times_finer = 1;
  /// What has the topology of the input: the rungs, if the parts kept it, else those climbed before
  /// that did; none if there were none.
  std::vector<ChosenRung> kept;
  TopologyMode topology = TopologyMode::automatic;
};

/// How many times the target the parts together keep for the finish to choose from: twice where
/// much is taken away (measured: no better with more), less where little is, as then seams are few.
double provision(double ratio);

/// How many points to take of a surface of so many of the input's triangles, for all purposes.
std::uint64_t samples_for(const Manifest& manifest, const RunOptions& options,
                          std::uint64_t triangles);

/// Points of the whole surface: those that the error is measured by, and others that the vertices
/// of the result are fitted to. What is fitted to a point is near it, which is no measure.
struct SampleCounts {
  std::uint64_t measured = 0;
  std::uint64_t fitting = 0;  // 0: the vertices stay where they are
  std::uint64_t all() const { return measured + fitting; }
};
/// The option that vertices are not fitted with, and why; empty: they may be.
std::string why_not_fitted(const RunOptions& options);
SampleCounts sample_counts(const Manifest& manifest, const RunOptions& options);

/// Points that were taken for both.
struct SplitSamples {
  std::vector<SurfaceSamples> measured;
  std::vector<SurfaceSamples> fitting;  // none where none are to be fitted
};
/// Shares out the points of each set, evenly along it.
SplitSamples split_samples(std::vector<SurfaceSamples> all, const SampleCounts& counts);

/// How many collapses are refused to keep the topology by when so many free triangles are left, as
/// far as a rung tells: refusals a triangle rise with about the fourth power of what has gone.
double refused_by(const Rung& rung, double free_triangles);

/// Of one ladder: the coarsest rung that is not above `level`, else its first.
std::uint32_t rung_at(std::span<const Rung> ladder, std::int32_t level);

/// Free triangles of a part at a level. Where its ladder ends but goes on, so many as a smooth
/// surface would have.
std::uint64_t free_triangles_at(const ResultSummary& part, std::int32_t level);
/// Of all parts together.
std::uint64_t free_triangles_at(std::span<const ResultSummary> parts, std::int32_t level);

/// The coarsest level at which the parts together still hold `wanted` free triangles; the finest
/// there is if none does.
std::int32_t common_level(std::span<const ResultSummary> parts, std::uint64_t wanted);

}  // namespace meshfarm
