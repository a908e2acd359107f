// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/pipeline/run_options.hpp>

#include "pipeline/part_jobs.hpp"
#include "pipeline/part_results.hpp"

namespace meshfarm {

/// Long streams of which samples were climbed are swept themselves, at the chosen level.
class SweepStage {
 public:
  /// All must outlive this.
  SweepStage(const Manifest& manifest, const RunOptions& options, const PartJobs& jobs,
             PartResults& results);

  /// Asks for these streams at this level, again if they were asked for before.
  JobNeeds ask(JobGraph& graph, const std::vector<std::uint32_t>& streams, std::int32_t level);
  /// Call this once they are accepted.
  void take(const JobGraph& graph, const std::vector<std::uint32_t>& streams);
  /// Call this once all are accepted: whether all must be swept again, one level finer, because
  /// together they hold less than the target.
  bool is_too_coarse() const;
  /// Whether a stream's error is greater than allowed.
  bool is_too_far(std::uint32_t stream) const;

 private:
  JobName last_of(std::uint32_t stream) const;

  const Manifest& manifest_;
  const RunOptions& options_;
  const PartJobs& jobs_;
  PartResults& results_;
  std::vector<std::uint32_t> asked_;  // how often, per stream
};

}  // namespace meshfarm
