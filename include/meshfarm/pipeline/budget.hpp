// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// Of a bound on the error parts and finish keep to this share: between the points that they look
/// at a surface may be a little farther.
inline constexpr double k_bound_share = 0.92;
/// And parts, as the finish looks at other points of them, to this.
inline constexpr double k_bound_share_of_parts = 0.9;

/// The jobs of a run, round by round (see JobSource). First every part is simplified to a ladder:
/// snapshots at rising cost levels that are the same in all parts. From the rungs' counts one level
/// is chosen for all. A part whose ladder begins above that level was taken too far: it is asked
/// for again in the next round, with a finer start.
///
/// Parts keep their topology first. If so much of the mesh is then held back by it that the others
/// would pay for that, all are asked for again with the topology simplified.
///
/// Of a long stream a sample is climbed instead, and stands for the stream by its share of the
/// triangles; the stream itself is then swept at the level that was chosen. If the swept streams
/// together hold less than the target, they are swept again one level finer. Then neighbouring
/// streams may be composed (RunOptions::composition).
///
/// Where the stage holds slabs (Manifest::sorting), they are sorted before all that: a round of
/// sort jobs, and one that takes samples of long streams. From there on the run is the one that
/// sorted streams would have had.
///
/// Where a new texture is made, the sink then finishes the mesh, and rounds follow that find the
/// texture's colours (pipeline/bake_job.hpp).
JobSource make_job_source(const Manifest& manifest, const RunOptions& options);

/// What the largest job needs that is known of, in bytes. Where slabs are still to be sorted, what
/// comes after that is estimated.
std::uint64_t memory_wanted(const Manifest& manifest, const RunOptions& options);

/// The result of a part, or of composed streams, that counts, and the rung to stitch.
struct ChosenRung {
  FileRef file;
  std::uint32_t rung = 0;
  std::uint32_t parts = 1;               // that it holds
  std::uint64_t dropped_degenerate = 0;  // in the part
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
};

/// What to stitch, in the order of the parts, and how to finish it.
struct ChosenRungs {
  std::vector<ChosenRung> rungs;
  /// The same from a finer level that holds so many times the free triangles, a fifth more or
  /// somewhat above; none if the ladders have no such level.
  std::vector<ChosenRung> finer;
  double times_finer = 1;
  /// What has the topology of the input: the rungs, if the parts kept it, else those of a round
  /// before that did; none if there was none.
  std::vector<ChosenRung> kept;
  TopologyMode topology = TopologyMode::automatic;
  /// What was accepted after the rounds that these are of.
  std::span<const AcceptedJob> rest;
};

/// Once every job of make_job_source that makes the mesh is accepted. `accepted` must outlive it.
ChosenRungs choose_rungs(const Manifest& manifest, const RunOptions& options,
                         std::span<const AcceptedJob> accepted);

/// How many times the target the parts together keep for the finish to choose from: twice where
/// much is taken away (measured: no better with more), less where little is, as then seams are few.
double provision(double ratio);

/// How many points of a surface of so many of the input's triangles the error is measured by.
std::uint64_t samples_for(const Manifest& manifest, const RunOptions& options,
                          std::uint64_t triangles);

/// Of one ladder: the coarsest rung that is not above `level`, else its first.
std::uint32_t rung_at(std::span<const Rung> ladder, std::int32_t level);

/// The coarsest level at which the ladders together still hold `wanted` free triangles; the finest
/// there is if none does.
std::int32_t common_level(std::span<const std::vector<Rung>> ladders, std::uint64_t wanted);

}  // namespace meshfarm
