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

/// The cost threshold of all parts, and what they are to keep together for the finish.
struct ComposeGoal {
  std::int32_t level = 0;
  double max_cost = 0;
  double triangles = 0;
  TopologyMode topology = TopologyMode::keep;
  bool for_pieces = false;  // what comes of it is finished piece by piece
};

/// Joins neighbours, and what came of that again (Xiong et al. 2008, 4.3): a few at once, and no
/// more than a worker could hold when it simplified them, so that it needs no more memory than for
/// that. Parts are numbered so that neighbours by number lie together, slabs anyway. What is then
/// left for the sink to join is one result, or such as are too large.
///
/// On its own this is done where the sink would be long at joining: from two million triangles on,
/// and only if they are much more than are wanted.
///
/// Neighbours are joined from the first on, as many as fit. So a job needs those that it joins and
/// those before them on its level, not the whole level.
class ComposeStage {
 public:
  using Done = std::function<void(JobGraph&, const std::vector<ComposedParts>&)>;

  /// Both must outlive this.
  ComposeStage(const Manifest& manifest, const RunOptions& options)
      : manifest_(manifest), options_(options) {}

  /// `done` is called once nothing more is to be joined.
  void begin(JobGraph& graph, const ComposeGoal& goal, std::vector<ComposedParts> parts, Done done);

 private:
  /// The parts as they were simplified, then what came of joining these, and so on.
  struct Level {
    std::vector<ComposedParts> parts;
    std::size_t taken = 0;        // the first of these are there
    std::size_t first = 0;        // not in a group yet
    std::uint64_t triangles = 0;  // of those taken
    bool whole = false;           // all are known
    bool joins = false;           // any of them
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
  std::uint64_t weight_ = 0;          // of all
  std::uint64_t most_triangles_ = 0;  // of a group
  std::deque<Level> levels_;
};

}  // namespace meshfarm
