// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// The result of a part or stream, or of neighbours that were composed.
struct ComposedParts {
  ChosenRung chosen;
  std::uint64_t triangles = 0;  // of the rung
  std::uint64_t weight = 0;     // free triangles of its parts before anything was composed
};

/// The cost threshold of all parts, and the triangles that they keep for the finish.
struct ComposeGoal {
  std::int32_t level = 0;
  double max_cost = 0;
  double triangles = 0;
  TopologyMode topology = TopologyMode::keep;
  bool for_pieces = false;  // the composed parts are finished piece by piece
};

/// Joins neighbours, and the results of that again (Xiong et al. 2008, 4.3): a few at once, and no
/// more than a worker could hold when it simplified them, so that joining needs no more memory than
/// that. Parts with neighbouring numbers lie together, as slabs do anyway. What is left for the
/// sink to join is one result, or results that are too large.
///
/// By default this is done only if joining would take the sink long: from two million triangles on,
/// and only if they are many more than wanted.
///
/// Neighbours are joined starting with the first, as many as fit. So a job needs the results that
/// it joins and those before them on its level, not the whole level.
class ComposeStage {
 public:
  using Done = std::function<void(JobGraph&, const std::vector<ComposedParts>&)>;

  /// Both must outlive this.
  ComposeStage(const Manifest& manifest, const RunOptions& options)
      : manifest_(manifest), options_(options) {}

  /// `done` is called once there is nothing more to join.
  void begin(JobGraph& graph, const ComposeGoal& goal, std::vector<ComposedParts> parts, Done done);

 private:
  /// The parts as they were simplified, then the results of joining these, and so on.
  struct Level {
    std::vector<ComposedParts> parts;
    std::size_t taken = 0;        // how many of these are there, from the first on
    std::size_t first = 0;        // the first that is not in a group yet
    std::uint64_t triangles = 0;  // of those taken
    bool whole = false;           // all are known
    bool joins = false;           // whether any of them are joined
  };

  bool can_join() const;
  std::uint64_t most_triangles(std::uint64_t all_triangles) const;
  bool is_worth_it(const Level& level) const;
  void take(JobGraph& graph, std::size_t number);
  void join(JobGraph& graph, std::size_t number);
  void close_group(JobGraph& graph, std::size_t number, std::size_t end);
  std::uint64_t work_after(std::uint64_t triangles, std::uint64_t parts) const;
  Job job_of(const Level& level, std::size_t first, std::size_t end) const;
  void end_level(JobGraph& graph, std::size_t number);

  const Manifest& manifest_;
  const RunOptions& options_;
  ComposeGoal goal_;
  Done done_;
  std::uint64_t weight_ = 0;          // sum over all parts
  std::uint64_t most_triangles_ = 0;  // of a group
  std::deque<Level> levels_;
};

}  // namespace meshfarm
