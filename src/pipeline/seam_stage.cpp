// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The jobs of a farmed finish that join the surroundings of the seams.
#include <algorithm>
#include <utility>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/pipeline/budget.hpp>

#include "pipeline/finish_stage.hpp"
#include "pipeline/run_stages.hpp"

namespace meshfarm {
namespace {

/// A seam job takes about k_seam_triangles triangles around the seams, or up to
/// k_most_seam_triangles if there are jobs for two dozen workers. It also reads the strips of
/// k_pieces_round_group more pieces.
constexpr std::uint64_t k_seam_triangles = 24'000;
constexpr std::uint64_t k_most_seam_triangles = 150'000;
constexpr std::uint64_t k_usual_groups = 24;
constexpr std::uint64_t k_pieces_round_group = 20;
/// Measured: joining them takes the work of simplifying this many times as many triangles.
constexpr std::uint64_t k_seam_work = 3;
/// Under a bound, a group has about this many triangles of the input near it; the memory and the
/// work per triangle follow.
constexpr std::uint64_t k_bounded_input = 1'000'000;
constexpr std::uint64_t k_bounded_input_bytes = 560;
constexpr std::uint64_t k_bounded_work = 1;
/// With fewer pieces, groups meet nearly everywhere: on foam in 7 pieces that is 2.5 % of the
/// error.
constexpr std::uint64_t k_least_pieces_for_groups = 12;

}  // namespace

void FinishStage::join_seams(JobGraph& graph) {
  const std::uint32_t groups = groups_of_seams();
  const std::size_t first = std::exchange(seam_jobs_, seam_jobs_ + groups);
  for (std::uint32_t group = 0; group < groups; ++group) {
    graph.add(job_name(RunStage::seam, first + group), seam_job(group, groups));
  }
  graph.then({jobs_of(RunStage::seam, first, groups)}, [this, first, groups](JobGraph& so_far) {
    for (std::uint32_t group = 0; group < groups; ++group) {
      made_.pieces.emplace_back();
      take_divided(so_far, made_.pieces.size() - 1, job_name(RunStage::seam, first + group));
    }
    by_error() ? keep_all(so_far) : weigh(so_far);
  });
}

std::uint32_t FinishStage::groups_of_seams() const {
  std::uint64_t triangles = manifest_.boundary_triangles;
  for (const PieceOfResult& each : made_.pieces) triangles += each.divided.strip_triangles;
  const std::uint64_t pieces = made_.pieces.size();
  if (pieces < k_least_pieces_for_groups) return 1;
  std::uint64_t groups = triangles / k_seam_triangles;
  if (by_error()) groups = std::max(groups, input_round_seams() / k_bounded_input);
  const std::uint64_t most = std::max(k_usual_groups, triangles / k_most_seam_triangles);
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(groups, 1, std::min(pieces, by_error() ? pieces : most)));
}

/// The number of the input's triangles around the seams, estimated from the share of each piece
/// that went to the surroundings.
std::uint64_t FinishStage::input_round_seams() const {
  double triangles = static_cast<double>(manifest_.boundary_triangles);
  for (const PieceOfResult& each : made_.pieces) {
    const auto strip = static_cast<double>(each.divided.strip_triangles);
    const double all =
        strip + static_cast<double>(each.divided.weight.before + each.divided.gap_triangles);
    double input = 0;
    for (std::uint32_t p = each.first_part; p < each.first_part + each.parts; ++p) {
      input += static_cast<double>(manifest_.parts[p].triangles);
    }
    if (strip > 0) triangles += input * strip / all;
  }
  return static_cast<std::uint64_t>(triangles);
}

Job FinishStage::seam_job(std::uint32_t group, std::uint32_t groups) const {
  SeamParameters parameters;
  parameters.group = group;
  parameters.groups = groups;
  std::uint64_t triangles = manifest_.boundary_triangles;
  for (const PieceOfResult& each : made_.pieces) {
    parameters.strips.push_back(
        {each.parts, {each.divided_file, each.divided.strip}, each.divided.mesh, each.divided.gap});
    triangles += each.divided.strip_triangles;
  }
  parameters.all_parts = static_cast<std::uint32_t>(manifest_.parts.size());
  parameters.boundary = manifest_.boundary;
  parameters.samples_per_triangle =
      std::min(100.0, static_cast<double>(samples_for(manifest_, options_, manifest_.triangles())) /
                          static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles())));
  parameters.weigh = weigh_;
  if (by_error()) parameters.bound = bound();
  Job job;
  job.kind = k_seam_kind;
  job.parameters = encode_parameters(parameters);
  job.cost = k_seam_work * triangles / groups + 1;
  const std::uint64_t pieces = made_.pieces.size();
  const std::uint64_t near = std::min(pieces, pieces / groups + 1 + k_pieces_round_group);
  job.memory =
      k_piece_process_bytes + (bytes_of(manifest_.boundary) + k_piece_triangle_bytes * triangles +
                               memory_of_channels(weigh_.lines, triangles)) *
                                  near / pieces;
  if (!by_error()) return job;
  job.memory += memory_of_bound(groups);
  job.cost += k_bounded_work * input_round_seams() / groups;
  return job;
}

GroupBound FinishStage::bound() const {
  const double error = options_.error.in(manifest_.box);
  return {k_bound_share * error, options_.certify ? error : 0, manifest_.bundles};
}

/// Memory for the input near the seams of a group, while one part of it is read.
std::uint64_t FinishStage::memory_of_bound(std::uint32_t groups) const {
  std::uint64_t part = 0;
  for (const PartEntry& each : manifest_.parts) {
    part = std::max(part, manifest_.bundles ? k_built_triangle_bytes * each.triangles
                                            : each.file.size + 60 * each.triangles);
  }
  return part + k_bounded_input_bytes * input_round_seams() / groups;
}

}  // namespace meshfarm
