// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/cut_stage.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bundle_list.hpp"
#include "pipeline/part_jobs.hpp"
#include "pipeline/run_stages.hpp"

namespace meshfarm {
namespace {

/// Measured: this many vertices or triangles take the work of simplifying one triangle.
constexpr std::uint64_t k_surveyed = 30;
constexpr std::uint64_t k_counted = 15;
constexpr std::uint64_t k_scattered_vertices = 9;
constexpr std::uint64_t k_scattered_triangles = 8;
constexpr std::uint64_t k_joined = 4;
constexpr std::uint64_t k_partitioned = 2;  // times the work, per cell

constexpr std::uint64_t k_cut_process_bytes = std::uint64_t{16} << 20;
constexpr std::uint64_t k_cell_bytes_in_memory = 300;   // in a tree, and in its encoding
constexpr std::uint64_t k_cell_bytes_of_places = 50;    // the same for CellPlaces
constexpr std::uint64_t k_cell_bytes_of_graph = 1'000;  // while it is partitioned
constexpr std::uint64_t k_seam_triangle_bytes = 24;     // in bundles
constexpr std::uint64_t k_joined_triangle_bytes = 150;  // while they are joined
/// A message names the results of at most this many parts. If there are more, the sink joins the
/// boundary, which it then reads from the bundles.
constexpr std::uint32_t k_most_parts_named = 2'500;
constexpr std::uint64_t k_most_cells = std::uint64_t{1} << 20;
constexpr std::uint64_t k_cells_a_part = 1024;

std::uint64_t likely_cells(std::uint32_t parts) {
  return std::min(k_most_cells, k_cells_a_part * parts);
}

/// In bytes, without those of the process.
struct MemoryOfCut {
  explicit MemoryOfCut(const Manifest& manifest, const Cutting& cutting) {
    const std::uint64_t cells = likely_cells(cutting.parts);
    const std::uint64_t vertices = manifest.input_vertices / cutting.vertex_blocks + 1;
    const std::uint64_t triangles = manifest.input_triangles / cutting.triangle_blocks + 1;
    count = k_cell_bytes_in_memory * cells;
    partition = k_cell_bytes_of_graph * cells;
    scatter_vertices = k_cell_bytes_of_places * cells + 60 * vertices;
    scatter_triangles = 60 * triangles + 16 * vertices;
  }
  std::uint64_t count = 0;
  std::uint64_t partition = 0;
  std::uint64_t scatter_vertices = 0;
  std::uint64_t scatter_triangles = 0;
};

std::string what_of(const JobOutput& output) {
  return "summary of " + output.file.name;
}

}  // namespace

void CutStage::begin(JobGraph& graph, JobGraph::Step then) {
  cuts_ = true;
  cutting_ = *manifest_.cutting;
  bundles_.positions = manifest_.positions;
  then_ = std::move(then);
  survey(graph);
}

std::uint64_t CutStage::vertices_of_block() const {
  return manifest_.input_vertices / cutting_.vertex_blocks + 1;
}

std::uint64_t CutStage::triangles_of_block() const {
  return manifest_.input_triangles / cutting_.triangle_blocks + 1;
}

/// Bytes of the coordinates in a block, approximately.
std::uint64_t CutStage::bytes_of_vertices() const {
  const std::uint64_t all =
      3 * static_cast<std::uint64_t>(manifest_.positions) * manifest_.input_vertices;
  return std::min(all, cutting_.bytes) / cutting_.vertex_blocks;
}

void CutStage::reads_vertices(Job& job, std::uint32_t block) const {
  job.reads = bytes_of_vertices();
  job.extent = extent_named("vertices", block, job.reads);
}

Job CutStage::job_of(std::string_view kind, std::uint64_t cost, std::uint64_t memory) const {
  Job job;
  job.kind = kind;
  job.cost = 1 + cost;
  job.memory = k_cut_process_bytes + memory;
  job.left_to_readers = is_left_to_readers(kind) && cutting_.parts <= k_most_parts_named;
  return job;
}

void CutStage::survey(JobGraph& graph) {
  for (std::uint32_t b = 0; b < cutting_.vertex_blocks; ++b) {
    Job job = job_of(k_survey_kind, vertices_of_block() / k_surveyed, 0);
    reads_vertices(job, b);
    job.parameters = encode_parameters(CutJobParameters{cutting_, b, 0, {}, {}});
    graph.add(job_name(RunStage::survey, b), std::move(job));
  }
  graph.then({jobs_of(RunStage::survey, 0, cutting_.vertex_blocks)}, [this](JobGraph& so_far) {
    take_surveys(so_far);
    count(so_far, 0);
  });
}

void CutStage::take_surveys(const JobGraph& graph) {
  for (std::uint32_t b = 0; b < cutting_.vertex_blocks; ++b) {
    const JobOutput& output = graph.output(job_name(RunStage::survey, b));
    const BlockSurvey survey = decode_survey(output.summary, what_of(output));
    manifest_.box.add(survey.box.lo);
    manifest_.box.add(survey.box.hi);
  }
}

/// One round: all blocks, then the partition, which may ask for another round.
void CutStage::count(JobGraph& graph, std::uint32_t round) {
  const std::uint32_t blocks = cutting_.vertex_blocks;
  const std::uint64_t cells = likely_cells(cutting_.parts);
  for (std::uint32_t b = 0; b < blocks; ++b) {
    Job job = job_of(k_count_kind, vertices_of_block() / k_counted,
                     MemoryOfCut(manifest_, cutting_).count);
    if (round > 0) job.inputs = {cells_};
    reads_vertices(job, b);
    job.parameters = encode_parameters(
        CutJobParameters{cutting_, b, round, round == 0 ? manifest_.box : Box{}, {}});
    graph.add(job_name(RunStage::count, round * blocks + b), std::move(job));
  }
  const JobRange counted = jobs_of(RunStage::count, std::size_t{round} * blocks, blocks);
  const JobName name = job_name(RunStage::partition, round);
  graph.add(name, {counted}, [this, round, blocks, cells](JobGraph& so_far) {
    Job job =
        job_of(k_partition_kind, k_partitioned * cells, MemoryOfCut(manifest_, cutting_).partition);
    if (round > 0) job.inputs = {cells_};
    for (std::uint32_t b = 0; b < blocks; ++b) {
      job.inputs.push_back(so_far.output(job_name(RunStage::count, round * blocks + b)).file);
    }
    job.parameters = encode_parameters(
        CutJobParameters{cutting_, 0, round, round == 0 ? manifest_.box : Box{}, {}});
    return std::optional<Job>(std::move(job));
  });
  graph.then({just(name)}, [this, round, name](JobGraph& so_far) {
    const JobOutput& output = so_far.output(name);
    const PartitionSummary made = decode_partition_summary(output.summary, what_of(output));
    cells_ = output.file;
    if (made.counts_again) return count(so_far, round + 1);
    bundles_.parts = made.parts;
    scatter_vertices(so_far);
  });
}

void CutStage::scatter_vertices(JobGraph& graph) {
  for (std::uint32_t b = 0; b < cutting_.vertex_blocks; ++b) {
    Job job = job_of(k_vertices_kind, vertices_of_block() / k_scattered_vertices,
                     MemoryOfCut(manifest_, cutting_).scatter_vertices);
    job.inputs = {cells_};
    reads_vertices(job, b);
    job.parameters = encode_parameters(CutJobParameters{cutting_, b, 0, {}, {}});
    graph.add(job_name(RunStage::vertices, b), std::move(job));
  }
  graph.then({jobs_of(RunStage::vertices, 0, cutting_.vertex_blocks)}, [this](JobGraph& so_far) {
    take_vertices(so_far);
    scatter_triangles(so_far);
  });
}

void CutStage::take_vertices(const JobGraph& graph) {
  for (std::uint32_t b = 0; b < cutting_.vertex_blocks; ++b) {
    const JobOutput& output = graph.output(job_name(RunStage::vertices, b));
    const VertexBundle bundle = decode_vertex_bundle(output.summary, what_of(output));
    bundles_.vertices.push_back({output.file, bundle});
    manifest_.coincident_vertices += bundle.merged;
  }
}

void CutStage::scatter_triangles(JobGraph& graph) {
  for (std::uint32_t b = 0; b < cutting_.triangle_blocks; ++b) {
    Job job = job_of(k_triangles_kind, triangles_of_block() / k_scattered_triangles,
                     MemoryOfCut(manifest_, cutting_).scatter_triangles);
    job.reads =
        (cutting_.bytes - cutting_.vertex_blocks * bytes_of_vertices()) / cutting_.triangle_blocks;
    job.parameters = encode_parameters(CutJobParameters{cutting_, b, 0, {}, bundles_});
    graph.add(job_name(RunStage::triangles, b), std::move(job));
  }
  graph.then({jobs_of(RunStage::triangles, 0, cutting_.triangle_blocks)}, [this](JobGraph& so_far) {
    take_triangles(so_far);
    manifest_.cutting.reset();
    manifest_.parts.resize(bundles_.parts);
    manifest_.bundles = bundles_;
    then_(so_far);
  });
}

void CutStage::take_triangles(const JobGraph& graph) {
  for (std::uint32_t b = 0; b < cutting_.triangle_blocks; ++b) {
    const JobOutput& output = graph.output(job_name(RunStage::triangles, b));
    const TriangleBundle bundle = decode_triangle_bundle(output.summary, what_of(output));
    bundles_.triangles.push_back({output.file, bundle});
    manifest_.dropped_not_finite += bundle.dropped;
    manifest_.dropped_degenerate += bundle.points_left_out;
    manifest_.coincident_corners += bundle.points_left_out;
  }
}

void CutStage::join(JobGraph& graph, const PartResults& results, JobGraph::Step then) {
  if (!cuts_ || std::exchange(joined_, true)) return then(graph);
  take_ladders(results);
  JoinParameters parameters;
  std::uint64_t read = 0;
  std::uint64_t triangles = 0;
  for (std::size_t p = 0; p < results.files.size(); ++p) {
    parameters.numbers.push_back({results.files[p], results.summaries[p].beside});
    read += parameters.numbers.back().section.size;
  }
  for (const TriangleBundleRef& each : bundles_.triangles) triangles += each.bundle.seam_triangles;
  read += k_seam_triangle_bytes * triangles;
  const std::uint32_t groups = RegionGroups(bundles_.parts).count();
  for (parameters.group = 0; parameters.group < groups; ++parameters.group) {
    parameters.bundles = bundles_of_group(bundles_, parameters.group);
    Job job = job_of(k_join_kind, triangles / groups / k_joined,
                     k_joined_triangle_bytes * triangles / groups);
    job.reads = read / groups;
    job.parameters = encode_parameters(parameters);
    job.by_sink = cutting_.parts > k_most_parts_named;
    graph.add(job_name(RunStage::join, parameters.group), std::move(job));
  }
  graph.then({jobs_of(RunStage::join, 0, groups)},
             [this, groups, then = std::move(then)](JobGraph& so_far) {
               for (std::uint32_t group = 0; group < groups; ++group) take_boundary(so_far, group);
               then(so_far);
             });
}

void CutStage::take_ladders(const PartResults& results) {
  for (std::size_t p = 0; p < results.files.size(); ++p) {
    const std::optional<BuiltFacts>& built = results.summaries[p].built;
    if (!built) throw DataError(results.files[p].name + ": does not tell of the part it is of");
    PartEntry& part = manifest_.parts[p];
    part.vertices = built->vertices;
    part.triangles = built->triangles;
    part.boundary_vertices = built->boundary_vertices;
    part.shared_triangles = built->shared_triangles;
    part.shared_boundary = built->shared_boundary;
    manifest_.coincident_vertices += built->coincident_vertices;
    manifest_.dropped_degenerate += built->dropped_degenerate;
    manifest_.coincident_corners += built->coincident_corners;
  }
}

void CutStage::take_boundary(const JobGraph& graph, std::uint32_t group) {
  const JobOutput& joined = graph.output(job_name(RunStage::join, group));
  const JoinSummary summary = decode_join_summary(joined.summary, what_of(joined));
  manifest_.boundary.push_back(
      {joined.file, summary.index, RegionGroups(bundles_.parts).first_region(group)});
  manifest_.boundary_triangles += summary.triangles;
  manifest_.dropped_degenerate += summary.degenerate;
  manifest_.coincident_corners += summary.coincident;
  manifest_.dropped_duplicate += summary.duplicate;
}

std::uint64_t memory_of_cut(const Manifest& manifest) {
  const MemoryOfCut memory(manifest, *manifest.cutting);
  const std::uint64_t average = manifest.input_triangles / manifest.cutting->parts + 1;
  return std::max(
      {k_cut_process_bytes + std::max(memory.count, memory.partition),
       k_cut_process_bytes + std::max(memory.scatter_vertices, memory.scatter_triangles),
       memory_to_build(average)});
}

Manifest as_if_cut(Manifest manifest) {
  const std::uint32_t parts = manifest.cutting->parts;
  manifest.cutting.reset();
  PartEntry part;
  constexpr std::uint64_t k_tenths = 12;  // the largest part, in tenths of the average
  part.triangles = k_tenths * manifest.input_triangles / parts / 10 + 1;
  part.vertices = part.triangles / 2 + 1;
  part.shared_triangles = part.triangles;
  constexpr std::uint64_t k_part_bytes = 24;
  part.file.size = k_part_bytes * part.triangles;
  manifest.parts.assign(parts, part);
  return manifest;
}

}  // namespace meshfarm
