// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/sweep_stage.hpp"

#include "pipeline/run_stages.hpp"

namespace meshfarm {

SweepStage::SweepStage(const Manifest& manifest, const RunOptions& options, const PartJobs& jobs,
                       PartResults& results)
    : manifest_(manifest),
      options_(options),
      jobs_(jobs),
      results_(results),
      asked_(manifest.parts.size()) {}

JobNeeds SweepStage::ask(JobGraph& graph, const std::vector<std::uint32_t>& streams,
                         std::int32_t level) {
  JobNeeds asked;
  for (const std::uint32_t stream : streams) {
    ++asked_[stream];
    graph.add(last_of(stream), jobs_.sweep(stream, level, results_.topology));
    asked.push_back(just(last_of(stream)));
  }
  return asked;
}

/// The name of the last job asked for.
JobName SweepStage::last_of(std::uint32_t stream) const {
  return job_name(RunStage::sweep, (asked_[stream] - 1) * manifest_.parts.size() + stream);
}

void SweepStage::take(const JobGraph& graph, const std::vector<std::uint32_t>& streams) {
  for (const std::uint32_t stream : streams) results_.take(stream, graph, last_of(stream));
}

bool SweepStage::is_too_coarse() const {
  return jobs_.climbs_samples() && results_.level >= 0 &&
         static_cast<double>(results_.free_triangles(results_.level)) <
             jobs_.free_share() * static_cast<double>(jobs_.target());
}

bool SweepStage::is_too_far(std::uint32_t stream) const {
  return results_.summaries[stream].rungs.front().error >
         k_error_share * options_.error.in(manifest_.box);
}

}  // namespace meshfarm
