// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>

namespace meshfarm {

/// The share of a bound on the error for streams that are swept by cost.
constexpr double k_error_share = 0.5;

/// A ladder begins at this multiple of the part's even share, so that a detailed part can keep more
/// than its share; a part that deserves even more is climbed again.
constexpr double k_first_headroom = 4;

/// The memory to build a part of this average size and to climb it.
std::uint64_t memory_to_build(std::uint64_t average_triangles);

/// A part's file, or the sections that it is built from.
Extent extent_of_part(std::uint32_t part, std::uint64_t bytes);

/// Makes the jobs for single parts and streams, with parameters that follow from the run's options
/// alone.
class PartJobs {
 public:
  /// All must outlive this. `bundles`: to build the parts from; null if the parts exist.
  PartJobs(const Manifest& manifest, const RunOptions& options,
           const BundlesOfMesh* bundles = nullptr);

  std::uint64_t target() const;
  /// The wanted share of the existing triangles.
  double ratio() const;
  /// The triangles that the parts together keep for the finish to choose from.
  double wanted() const;
  /// The share of the input's triangles that touch no boundary vertex. The others stay as they are
  /// until the finish.
  double free_share() const;
  /// As many of those as are wanted.
  double wanted_free() const { return wanted() * free_share(); }
  bool by_error() const { return options_.error.value > 0; }
  /// Whether a level must be found: the same ratio everywhere needs none.
  bool climbs_samples() const { return by_error() || options_.allocation == Allocation::threshold; }
  bool is_sampled(std::uint32_t part) const;
  /// The number of triangles that any ladder of this part leaves.
  double least_of(std::uint32_t part) const;

  /// Climbs the ladder of a part, or of a sample of a long stream, starting at `headroom` times its
  /// even share.
  Job climb(std::uint32_t part, double headroom, TopologyMode topology) const;
  /// The same from an existing rung, without predicting refusals.
  Job climb_on(std::uint32_t part, const ChosenRung& from, const Rung& rung,
               TopologyMode topology) const;
  /// Sweeps a long stream to a level.
  Job sweep(std::uint32_t part, std::int32_t level, TopologyMode topology) const;
  /// The highest cost of a collapse in a sweep to this level; below 0 if none is allowed.
  double sweep_cost(std::int32_t level) const;

 private:
  const PartEntry& climbed(std::uint32_t part) const;
  SimplifyParameters parameters_of(TopologyMode topology) const;
  void set_share_of(SimplifyParameters& parameters, std::uint32_t part, double headroom) const;
  void set_error_bound(SimplifyParameters& parameters, std::uint32_t part) const;
  Job build_and_climb(std::uint32_t part, double headroom, SimplifyParameters parameters) const;
  std::uint64_t memory_of_bound(std::uint64_t triangles) const;
  ShareRule share_rule(double headroom) const;
  double end_of_ladders() const;

  const Manifest& manifest_;
  const RunOptions& options_;
  const BundlesOfMesh* bundles_;
  bool finishes_here_;  // in the sink, as one mesh
};

}  // namespace meshfarm
