// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/components_stage.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/finish_stage.hpp"
#include "pipeline/run_stages.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_finder_process_bytes = std::uint64_t{16} << 20;
/// For the current piece.
constexpr std::uint64_t k_finder_triangle_bytes = 100;
/// For the triangles between parts: the file and its decoded forms.
constexpr std::uint64_t k_boundary_copies = 6;

}  // namespace

Job components_job(const Manifest& manifest, const RunOptions& options,
                   const std::vector<ComposedParts>& pieces) {
  ComponentsParameters parameters;
  Job job;
  job.kind = k_components_kind;
  std::uint64_t most = 0;
  for (const ComposedParts& each : pieces) {
    const RungPlace& place = each.chosen.place;
    const std::uint64_t bytes = place.rung.size + place.tail.size;
    parameters.pieces.push_back(
        {each.chosen.parts, each.chosen.rung, each.chosen.file, place.rung, place.tail});
    most = std::max(most, bytes + k_finder_triangle_bytes * each.triangles +
                              memory_of_channels(lines_of(manifest, options), each.triangles));
    job.cost += each.triangles;
    job.reads += bytes;
  }
  parameters.all_parts = static_cast<std::uint32_t>(manifest.parts.size());
  parameters.boundary = manifest.boundary;
  parameters.diagonal = options.drop_components.in(manifest.box);
  job.parameters = encode_parameters(parameters);
  job.memory = k_finder_process_bytes + most + k_boundary_copies * bytes_of(manifest.boundary);
  return job;
}

void FinishStage::find_components(JobGraph& graph) {
  const JobName name = job_name(RunStage::components, 0);
  Job job = components_job(manifest_, options_, parts_);
  if (job.parameters.size() > k_max_parameters_bytes) {
    return done_(graph, std::nullopt, "there are more pieces than a job can name");
  }
  graph.add(name, std::move(job));
  graph.then({just(name)}, [this, name](JobGraph& so_far) {
    const JobOutput& output = so_far.output(name);
    const SmallComponents found =
        decode_small_components(output.summary, "summary of " + output.file.name);
    if (found.pieces.size() != parts_.size()) {
      throw DataError(output.file.name + ": is of other pieces");
    }
    made_.dropped_components = found.dropped;
    for (const FileSection& each : found.pieces) small_components_.push_back({output.file, each});
    begin_pieces(so_far);
  });
}

}  // namespace meshfarm
