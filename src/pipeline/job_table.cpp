// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/compose_job.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/pipeline/sort_job.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bundle_list.hpp"

namespace meshfarm {
namespace {

using JobPointer = JobOutput (*)(const Job&, const JobContext&);

constexpr std::pair<std::string_view, JobPointer> k_table[] = {
    {k_sort_kind, sort_to_stream},
    {k_sample_kind, sample_stream},
    {k_simplify_kind, simplify_part},
    {k_sweep_kind, sweep_stream},
    {k_compose_kind, compose_parts},
    {k_tile_kind, tile_pictures},
    {k_bake_kind, bake_chunk},
    {k_survey_kind, survey_vertices_of_block},
    {k_count_kind, count_vertices_of_block},
    {k_partition_kind, partition_cells_of_blocks},
    {k_vertices_kind, scatter_vertices_of_block},
    {k_triangles_kind, scatter_triangles_of_block},
    {k_join_kind, join_boundary_of_parts},
    {k_components_kind, find_small_components},
    {k_split_kind, split_piece},
    {k_seam_kind, join_seams},
    {k_reduce_kind, reduce_piece},
    {k_measure_kind, measure_piece},
};

/// Returns whether it is a job of the cut.
bool check_output_of_cut(std::string_view kind, const JobOutput& output, const std::string& what) {
  if (kind == k_survey_kind) {
    decode_survey(output.summary, what);
  } else if (kind == k_count_kind) {
    if (!output.summary.empty()) throw DataError(what + ": there should be none");
  } else if (kind == k_partition_kind) {
    decode_partition_summary(output.summary, what);
  } else if (kind == k_vertices_kind) {
    decode_vertex_bundle(output.summary, what);
  } else if (kind == k_triangles_kind) {
    decode_triangle_bundle(output.summary, what);
  } else if (kind == k_join_kind) {
    decode_join_summary(output.summary, what);
  } else {
    return false;
  }
  return true;
}

}  // namespace

JobOutput do_job(const Job& job, const JobContext& context) {
  for (const auto& [kind, function] : k_table) {
    if (kind == job.kind) return function(job, context);
  }
  throw DataError("unknown kind of job '" + job.kind + "'; is this worker of another version?");
}

void check_output(std::string_view kind, const JobOutput& output) {
  const std::string what = "summary of " + output.file.name;
  if (kind == k_sort_kind || kind == k_sample_kind) {
    decode_sort_summary(output.summary, what);
  } else if (kind == k_finish_kind) {
    decode_finish_summary(output.summary, what);
  } else if (kind == k_tile_kind) {
    decode_tile_summary(output.summary, what);
  } else if (kind == k_components_kind) {
    decode_small_components(output.summary, what);
  } else if (kind == k_split_kind || kind == k_seam_kind) {
    decode_divided_piece(output.summary, what);
  } else if (kind == k_reduce_kind) {
    decode_finished_piece(output.summary, what);
  } else if (kind == k_measure_kind) {
    decode_piece_error(output.summary, what);
  } else if (kind == k_bake_kind || kind == k_write_kind) {
    if (!output.summary.empty()) throw DataError(what + ": there should be none");
  } else if (!check_output_of_cut(kind, output, what)) {
    decode_summary(output.summary, what);
  }
}

}  // namespace meshfarm
