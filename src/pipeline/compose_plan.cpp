// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/compose_plan.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/compose_job.hpp>

namespace meshfarm {
namespace {

/// Joined at once: with two there are more rounds, with all of them nothing is left to share out.
constexpr std::size_t k_most_joined = 4;

/// The sink joins and finishes so many in about a second and 200 MB.
constexpr std::uint64_t k_worth_a_tree = 2'000'000;
/// Of what the streams are to keep together: with less there is little at the seams.
constexpr double k_worth_seams = 1.5;

/// The files as they are read, the joined mesh, the simplifier and the file that is written.
std::uint64_t memory_of_composition(std::uint64_t file_bytes, std::uint64_t triangles) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + file_bytes + 150 * triangles;
}

}  // namespace

ComposePlan::ComposePlan(const Manifest& manifest, const RunOptions& options,
                         const ComposeGoal& goal, std::vector<ComposedStreams> streams)
    : manifest_(manifest), options_(options), goal_(goal), streams_(std::move(streams)) {
  for (const ComposedStreams& each : streams_) weight_ += each.weight;
}

bool ComposePlan::is_worth_it() const {
  const bool can = manifest_.scheme == Scheme::stream && goal_.level >= 0 && weight_ > 0 &&
                   options_.allocation == Allocation::threshold &&
                   options_.finish == Finish::global && !(options_.error.value > 0);
  if (!can || options_.composition == Composition::sink) return false;
  if (options_.composition == Composition::tree) return true;
  std::uint64_t triangles = 0;
  for (const ComposedStreams& each : streams_) triangles += each.triangles;
  return triangles >= k_worth_a_tree &&
         static_cast<double>(triangles) > k_worth_seams * goal_.triangles;
}

/// Where each group ends. Neighbours are joined as long as they fit.
std::vector<std::size_t> ComposePlan::groups() const {
  const std::uint64_t seam = manifest_.boundary_triangles / manifest_.parts.size();
  std::vector<std::size_t> ends;
  for (std::size_t first = 0; first < streams_.size(); first = ends.back()) {
    std::uint64_t triangles = streams_[first].triangles;
    std::size_t end = first + 1;
    for (; end < streams_.size() && end - first < k_most_joined; ++end) {
      triangles += seam + streams_[end].triangles;
      if (triangles > manifest_.window_triangles) break;
    }
    ends.push_back(end);
  }
  return ends;
}

std::vector<Job> ComposePlan::jobs() const {
  std::vector<Job> jobs;
  if (!is_worth_it()) return jobs;
  std::size_t first = 0;
  for (const std::size_t end : groups()) {
    if (end - first > 1) jobs.push_back(job_of(first, end));
    first = end;
  }
  return jobs;
}

Job ComposePlan::job_of(std::size_t first, std::size_t end) const {
  ComposeParameters parameters;
  for (std::size_t i = 0; i < first; ++i) parameters.first_stream += streams_[i].chosen.parts;
  parameters.all_streams = static_cast<std::uint32_t>(manifest_.parts.size());
  parameters.boundary = manifest_.boundary;
  parameters.level = goal_.level;
  parameters.max_cost = goal_.max_cost;
  parameters.samples_per_triangle =
      std::min(1.0, static_cast<double>(samples_for(manifest_, options_, manifest_.triangles())) /
                        static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles())));
  parameters.lines = lines_of(manifest_, options_);
  parameters.lines.topology = goal_.topology;
  Job job;
  job.kind = k_compose_kind;
  std::uint64_t weight = 0;
  std::uint64_t bytes = 0;
  for (std::size_t i = first; i < end; ++i) {
    const ComposedStreams& each = streams_[i];
    parameters.inputs.push_back({each.chosen.parts, each.chosen.rung});
    job.inputs.push_back(each.chosen.file);
    job.cost += each.triangles;
    weight += each.weight;
    bytes += each.chosen.file.size;
  }
  parameters.floor = static_cast<std::uint64_t>(goal_.triangles * static_cast<double>(weight) /
                                                static_cast<double>(weight_));
  job.parameters = encode_parameters(parameters);
  job.memory =
      memory_of_composition(bytes, job.cost) + memory_of_channels(parameters.lines, job.cost);
  return job;
}

void ComposePlan::take(std::span<const AcceptedJob> round) {
  std::vector<ComposedStreams> composed;
  std::size_t first = 0;
  std::size_t next = 0;
  for (const std::size_t end : groups()) {
    ComposedStreams sum = streams_[first];
    for (std::size_t i = first + 1; i < end; ++i) {
      sum.chosen.parts += streams_[i].chosen.parts;
      sum.chosen.dropped_degenerate += streams_[i].chosen.dropped_degenerate;
      sum.chosen.dropped_duplicate += streams_[i].chosen.dropped_duplicate;
      sum.chosen.turned += streams_[i].chosen.turned;
      sum.weight += streams_[i].weight;
    }
    if (end - first > 1) {
      const JobOutput& output = round[next++].output;
      const ResultSummary summary =
          decode_summary(output.summary, "summary of " + output.file.name);
      sum.chosen.file = output.file;
      sum.chosen.rung = 0;
      sum.chosen.dropped_degenerate += summary.dropped_degenerate;
      sum.chosen.dropped_duplicate += summary.dropped_duplicate;
      sum.chosen.turned += summary.turned;
      sum.triangles = summary.rungs.front().triangles;
    }
    composed.push_back(std::move(sum));
    first = end;
  }
  streams_ = std::move(composed);
}

}  // namespace meshfarm
