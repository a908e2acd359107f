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

/// How to compute a part's share of the target from what was distributed to the part; used by
/// whoever builds it, the cut or the job itself.
struct ShareRule {
  double ratio = 1;     // wanted triangles / all triangles
  double headroom = 1;  // a ladder begins at this many times the share
  double end = 1;       // and may end at this many times what is kept for the finish
  std::uint64_t all_triangles = 0;
  std::uint64_t all_samples = 0;  // points of the whole surface
};

/// A part that the job builds itself, from the bundles of a cut by blocks.
struct PartToBuild {
  BundlesOfMesh bundles;
  std::uint32_t part = 0;
  ShareRule rule;
};

/// The position of a rung in a ladder.
struct RungOfLadder {
  std::uint32_t place = 0;
  std::int32_t level = 0;
};

/// Parameters of a simplify job.
struct SimplifyParameters {
  Allocation allocation = Allocation::threshold;
  std::uint64_t start_triangles = 0;  // the first rung: at most this many triangles
  std::uint64_t share_triangles = 0;  // the part's even share of the target
  std::uint64_t end_triangles = 0;    // the first rung with at most this many free may be the last
  /// The free triangles wanted of the part. The ladder ends where too many collapses are expected
  /// to be refused by then to keep the topology; 0: no such check.
  std::uint64_t foreseen_triangles = 0;
  std::uint64_t samples = 0;  // points of the part to measure the final error by
  double cost_unit = 0;       // cost of level 0
  double max_error = 0;       // where above 0: one rung, simplified as far as this distance allows
  /// Where above 0: it is proven for every point that no distance exceeds this. At least max_error.
  double certified_error = 0;
  LineOptions lines;
  std::optional<PartToBuild> build;  // then the job has no input, and finds its share by the rule
  std::optional<RungOfLadder> from;  // where set: the input is this rung of a ladder of the part
};

/// Estimates how many triangles of a part touch no boundary vertex, at least a quarter of all: two
/// per boundary vertex do.
double estimate_free(std::uint64_t triangles, std::uint64_t boundary_vertices);

/// Sets first rung, share, last rung and samples of a part.
void set_share(SimplifyParameters& parameters, const ShareRule& rule,
               std::uint64_t shared_triangles, std::uint32_t shared_boundary);

std::string encode_parameters(const SimplifyParameters& parameters);
SimplifyParameters decode_parameters(std::string_view bytes);

/// The level of a rung that is the unchanged part.
inline constexpr std::int32_t k_input_level = -1;

/// Cost levels rise by a factor of two from `unit`; on a smooth surface that is a factor of 1.26 in
/// triangles, as a cost is an area times a squared distance.
double level_cost(std::int32_t level, double unit);
inline constexpr double k_level_step = 1.26;
/// The lowest level, 0 or above, whose cost is at least `cost`.
std::int32_t level_of(double cost, double unit);
/// The cost of level 0 of a mesh with this diagonal: distances of 2^-50 of it.
double cost_unit(double diagonal);

/// A ladder leaves at least its even share divided by this: the flat areas of a part go in the
/// finish.
inline constexpr std::uint64_t k_shares_per_floor = 2;  // half

/// Simplifies one part or stream (the job's input, or one that it builds) to a ladder, or with
/// Allocation::uniform to one rung. The ladder ends once few enough triangles are left, or once it
/// is foreseen that the topology will be given up; if the topology is kept at any cost, it goes
/// down to half of the even share where many collapses are refused. If the topology may have to be
/// given up, the first rung is made before edges collapse strictly in order, which is when many may
/// be refused: another job can begin there.
JobOutput simplify_part(const Job& job, const JobContext& context);

}  // namespace meshfarm
