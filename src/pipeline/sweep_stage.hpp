// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/pipeline/run_options.hpp>

#include "pipeline/part_jobs.hpp"
#include "pipeline/part_results.hpp"

namespace meshfarm {

/// A long stream of which a sample was climbed is swept itself, at the level that was chosen.
class SweepStage {
 public:
  /// All must outlive this.
  SweepStage(const Manifest& manifest, const RunOptions& options, const PartJobs& jobs,
             PartResults& results);

  /// Asks for these streams at this level, once more if they were asked for before.
  JobNeeds ask(JobGraph& graph, const std::vector<std::uint32_t>& streams, std::int32_t level);
  /// Once they are there.
  void take(const JobGraph& graph, const std::vector<std::uint32_t>& streams);
  /// Once all are there: whether all are to be swept again, one level finer, as together they hold
  /// less than the target.
  bool is_too_coarse() const;
  /// Whether a stream was taken farther from what it was than it may be.
  bool is_too_far(std::uint32_t stream) const;

 private:
  JobName last_of(std::uint32_t stream) const;

  const Manifest& manifest_;
  const RunOptions& options_;
  const PartJobs& jobs_;
  PartResults& results_;
  std::vector<std::uint32_t> asked_;  // how often, by stream
};

}  // namespace meshfarm
