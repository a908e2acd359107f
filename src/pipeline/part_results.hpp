// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/budget.hpp>

namespace meshfarm {

/// The results of the stages that climb and sweep, by part.
struct PartResults {
  explicit PartResults(std::size_t parts) : made_by(parts), summaries(parts), files(parts) {}

  void take(std::uint32_t part, const JobGraph& graph, JobName job) {
    const JobOutput& output = graph.output(job);
    made_by[part] = job;
    summaries[part] = decode_summary(output.summary, "summary of " + output.file.name);
    files[part] = output.file;
  }
  /// As many as the ladders would have at this level, those that can go on included.
  std::uint64_t free_triangles(std::int32_t at_level) const {
    return free_triangles_at(summaries, at_level);
  }
  /// As many as the rungs of this level have.
  std::uint64_t free_triangles_made(std::int32_t at_level) const {
    std::uint64_t triangles = 0;
    for (const ResultSummary& result : summaries) {
      triangles += result.rungs[rung_at(result.rungs, at_level)].free_triangles;
    }
    return triangles;
  }

  std::vector<JobName> made_by;  // the last accepted job
  std::vector<ResultSummary> summaries;
  std::vector<FileRef> files;
  std::int32_t level = 0;  // the one chosen for all
  TopologyMode topology = TopologyMode::automatic;
};

}  // namespace meshfarm
