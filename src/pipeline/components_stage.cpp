// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/components_stage.hpp"

#include <algorithm>
#include <cstdint>

#include <meshfarm/pipeline/piece_jobs.hpp>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_finder_process_bytes = std::uint64_t{16} << 20;
/// Of the piece that is looked at.
constexpr std::uint64_t k_finder_triangle_bytes = 100;
/// Of the triangles between parts: the file, and what is made of it.
constexpr std::uint64_t k_boundary_copies = 6;

}  // namespace

Job components_job(const Manifest& manifest, const RunOptions& options,
                   const std::vector<ComposedParts>& pieces) {
  ComponentsParameters parameters;
  Job job;
  job.kind = k_components_kind;
  std::uint64_t most = 0;
  for (const ComposedParts& each : pieces) {
    parameters.pieces.push_back({each.chosen.parts, each.chosen.rung, each.chosen.file});
    most = std::max(most, each.chosen.file.size + k_finder_triangle_bytes * each.triangles +
                              memory_of_channels(lines_of(manifest, options), each.triangles));
    job.cost += each.triangles;
    job.reads += each.chosen.file.size;
  }
  parameters.all_parts = static_cast<std::uint32_t>(manifest.parts.size());
  parameters.boundary = manifest.boundary;
  parameters.diagonal = options.drop_components.in(manifest.box);
  job.parameters = encode_parameters(parameters);
  job.memory = k_finder_process_bytes + most + k_boundary_copies * manifest.boundary.size;
  return job;
}

}  // namespace meshfarm
