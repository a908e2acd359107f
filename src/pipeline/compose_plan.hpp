// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// The result of a stream, or of neighbours that were composed.
struct ComposedStreams {
  ChosenRung chosen;
  std::uint64_t triangles = 0;  // of the rung
  std::uint64_t weight = 0;     // free triangles of its streams before anything was composed
};

/// The cost threshold of all streams, and what they are to keep together for the finish.
struct ComposeGoal {
  std::int32_t level = 0;
  double max_cost = 0;
  double triangles = 0;
  TopologyMode topology = TopologyMode::keep;
};

/// Which neighbours are joined, round by round (Xiong et al. 2008, 4.3): a few at once, and no more
/// than a sweep's window holds, so that a worker needs no more memory than for a sweep. What is
/// then left for the sink to join is one result, or such as are too large.
///
/// A tree costs rounds, and each of its jobs reads the boundary triangles through. On its own it is
/// taken where the sink would be long at it: from two million triangles on, and only if the seams
/// are much of them (small parts of a sweep stay uncollapsed along them, whatever the goal).
class ComposePlan {
 public:
  ComposePlan(const Manifest& manifest, const RunOptions& options, const ComposeGoal& goal,
              std::vector<ComposedStreams> streams);
  /// The next round; none if nothing more is to be composed.
  std::vector<Job> jobs() const;
  /// The outputs of that round.
  void take(std::span<const AcceptedJob> round);
  const std::vector<ComposedStreams>& streams() const { return streams_; }

 private:
  bool is_worth_it() const;
  std::vector<std::size_t> groups() const;
  Job job_of(std::size_t first, std::size_t end) const;

  const Manifest& manifest_;
  const RunOptions& options_;
  ComposeGoal goal_;
  std::vector<ComposedStreams> streams_;
  std::uint64_t weight_ = 0;  // of all
};

}  // namespace meshfarm
