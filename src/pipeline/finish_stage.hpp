// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/pipeline/run_options.hpp>

#include "pipeline/compose_stage.hpp"

namespace meshfarm {

/// A seam job can name this many pieces.
inline constexpr std::size_t k_most_pieces = 400;
/// Parts are composed up to a 32nd of all triangles, so that many workers get a piece each, within
/// these bounds: much of a smaller piece would lie around the seams, and larger pieces waste the
/// memory of a process. If there are many boundary triangles, the minimum is k_least_by_seams times
/// their share of the input.
inline constexpr std::uint64_t k_least_piece = 60'000;
inline constexpr std::uint64_t k_least_with_long_seams = 131'072;
inline constexpr double k_least_by_seams = 1e7;
inline constexpr std::uint64_t k_usual_piece = 262'144;
inline constexpr std::uint64_t k_pieces_of_all = 32;

inline constexpr std::uint64_t k_piece_process_bytes = std::uint64_t{16} << 20;
/// The mesh, its simplifier, and the file that is written.
inline constexpr std::uint64_t k_piece_triangle_bytes = 170;
/// A part built temporarily, and what it is built from.
inline constexpr std::uint64_t k_built_triangle_bytes = 120;

/// Where all pieces start.
struct FinishGoal {
  std::int32_t step = -1;  // all pieces are collapsed to this first, slightly above the target
  double share = 1;        // of what is left then that the result keeps, about
  TopologyMode topology = TopologyMode::keep;
  bool may_simplify = false;  // the topology, if the count is not reached with it
};

/// The finish as jobs: pieces are divided again so that the seams lie inside, each is simplified to
/// its quota under one threshold computed from their weights, and measured in place.
class FinishStage {
 public:
  /// Called once the pieces are finished, and again when they are measured; or, with the reason,
  /// once it is clear that the sink has to finish.
  using Done = std::function<void(JobGraph&, std::optional<FinishedPieces>, std::string why_here)>;

  /// Both must outlive this.
  FinishStage(const Manifest& manifest, const RunOptions& options)
      : manifest_(manifest), options_(options) {}

  void begin(JobGraph& graph, const FinishGoal& goal, const std::vector<ComposedParts>& parts,
             Done done);

 private:
  Job split_job(const ComposedParts& parts, std::size_t number) const;
  void find_components(JobGraph& graph);
  Job seam_job(std::uint32_t group, std::uint32_t groups) const;
  Job reduce_job(std::size_t piece, std::uint64_t quota) const;
  Job measure_job(std::size_t number, const std::vector<PartRange>& ranges,
                  std::uint32_t share) const;
  std::vector<PartRange> ranges_of(const PieceOfResult& piece) const;
  static void take_measured(const JobGraph& graph, PieceOfResult& piece, std::size_t job);
  void begin_pieces(JobGraph& graph);
  void divide(JobGraph& graph);
  void take_divided(const JobGraph& graph, std::size_t piece, const JobName& name);
  void join_seams(JobGraph& graph);
  void weigh(JobGraph& graph);
  void step_back();
  void reduce(JobGraph& graph, const std::vector<std::uint64_t>& quotas);
  void look_at_count(JobGraph& graph);
  void keep_all(JobGraph& graph);
  bool by_error() const { return options_.error.value > 0; }
  std::uint32_t groups_of_seams() const;
  std::uint64_t input_round_seams() const;
  std::uint64_t memory_of_bound(std::uint32_t groups) const;
  GroupBound bound() const;
  void measure(JobGraph& graph);
  std::uint64_t bytes_of_bundles(std::uint64_t triangles) const;

  const Manifest& manifest_;
  const RunOptions& options_;
  Done done_;
  std::vector<ComposedParts> parts_;
  std::vector<SectionRef> small_components_;  // of each piece; empty if none are to be left out
  FinishGoal goal_;
  std::size_t turns_ = 0;  // how often pieces were divided
  // Jobs asked for so far.
  std::size_t split_jobs_ = 0;
  std::size_t seam_jobs_ = 0;
  std::size_t reduce_jobs_ = 0;
  std::int32_t step_ = -1;
  WeighParameters weigh_;
  FinishedPieces made_;
  std::vector<PieceWeight> weights_;
  std::vector<std::uint64_t> quotas_;
  std::size_t rounds_ = 0;  // in which quotas were assigned
};

}  // namespace meshfarm
