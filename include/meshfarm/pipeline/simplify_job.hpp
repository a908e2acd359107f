// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/farm/job.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

inline constexpr std::string_view k_simplify_kind = "simplify";

/// How a part's share of the target is found, by what was shared out to it: known to whoever builds
/// the part, whether that is the cut or the job itself.
struct ShareRule {
  double ratio = 1;       // of all triangles, those that are wanted
  double headroom = 1;    // a ladder begins at so many times the share
  double end = 1;         // and may end at so many times what is kept for the finish
  bool foresees = false;  // and where SimplifyParameters::foreseen_triangles tells
  std::uint64_t all_triangles = 0;
  std::uint64_t all_samples = 0;  // points of the whole surface
};

/// A part that the job builds itself, of the bundles of a cut by blocks.
struct PartToBuild {
  BundlesOfMesh bundles;
  std::uint32_t part = 0;
  ShareRule rule;
};

/// Where in a ladder a rung is.
struct RungOfLadder {
  std::uint32_t place = 0;
  std::int32_t level = 0;
};

/// Parameters of a simplify job.
struct SimplifyParameters {
  Allocation allocation = Allocation::threshold;
  std::uint64_t start_triangles = 0;  // the first rung: at most this many triangles
  std::uint64_t share_triangles = 0;  // the part's even share of the target
  std::uint64_t end_triangles = 0;    // the first rung with no more may be the last
  /// What is wanted of the part. Where it is foreseen that too many collapses are refused by then
  /// to keep the topology, the ladder ends; 0: that is not asked.
  std::uint64_t foreseen_triangles = 0;
  std::uint64_t samples = 0;  // points of the part to measure the final error by
  double cost_unit = 0;       // cost of level 0
  double max_error = 0;       // where above 0: one rung, as far as this distance is kept
  /// Where above 0: that no distance is greater than this is proven of every point. At least
  /// max_error.
  double certified_error = 0;
  LineOptions lines;
  std::optional<PartToBuild> build;  // the job has no input then, and finds its share by the rule
  std::optional<RungOfLadder> from;  // where set: the input is this, of a ladder of the part
};

/// Sets first rung, share, last rung and samples of a part.
void set_share(SimplifyParameters& parameters, const ShareRule& rule,
               std::uint64_t shared_triangles, std::uint32_t shared_boundary);

std::string encode_parameters(const SimplifyParameters& parameters);
SimplifyParameters decode_parameters(std::string_view bytes);

/// The level of a rung that is the part as it came.
inline constexpr std::int32_t k_input_level = -1;

/// Cost levels rise by a factor of four from `unit`; on a smooth surface that is a step of 1.6 in
/// triangles, as a cost is an area times a squared distance.
double level_cost(std::int32_t level, double unit);
inline constexpr double k_level_step = 1.6;
/// The lowest level, 0 or above, whose cost is at least `cost`.
std::int32_t level_of(double cost, double unit);
/// Level 0 of a mesh with this diagonal: distances of 2^-50 of it.
double cost_unit(double diagonal);

/// The least of its even share that a ladder leaves: what of a part is flat goes in the finish.
inline constexpr std::uint64_t k_shares_per_floor = 2;  // half

/// Simplifies one part or stream (the job's input, or one that it builds) to a ladder, or with
/// Allocation::uniform to one rung. The ladder ends once there is little enough, or where it is
/// foreseen that the topology is given up; with a topology that is kept at any cost it goes down to
/// half of the even share where much is refused. Where it may have to be given up, the first rung
/// is made before edges collapse strictly in order, which is when much may be refused: another job
/// can begin there.
JobOutput simplify_part(const Job& job, const JobContext& context);

}  // namespace meshfarm
