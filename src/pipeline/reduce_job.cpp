// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vertex_fit.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

void append_thinned(std::span<const Vec3> points, std::uint64_t most, std::vector<Vec3>& to) {
  if (most == 0) return;
  const std::uint64_t step = std::max<std::uint64_t>(1, (points.size() + most - 1) / most);
  for (std::size_t i = 0; i < points.size(); i += step) to.push_back(points[i]);
}

/// Vertices and midpoints of sides show the maximum distance of the surface.
std::vector<Vec3> points_of_piece(const Mesh& mesh, const ReduceParameters& parameters,
                                  FinishedPiece& made) {
  if (mesh.triangles.empty()) return {};
  SurfaceSamples samples = sample_surface(
      mesh, {.samples = std::max<std::uint64_t>(1, parameters.points), .threads = 1});
  made.area = samples.area;
  made.by_area = samples.points.size();
  append_thinned(mesh.positions, parameters.vertices, samples.points);
  append_thinned(middles_of_longest_sides(mesh.positions, mesh.triangles), parameters.vertices,
                 samples.points);
  return std::move(samples.points);
}

Mesh reduced(ResultMesh piece, const ReduceParameters& parameters, const JobContext& context) {
  const std::uint64_t before = piece.mesh.triangles.size();
  Simplifier simplifier(std::move(piece.mesh), {.locked_vertices = piece.boundary_vertices,
                                                .positions = piece.positions,
                                                .lines = parameters.lines,
                                                .was_simplified = true});
  bool given_up = false;
  simplifier.reduce({.triangles = parameters.triangles}, [&](std::uint64_t left) {
    given_up = !context.progress(before - std::min(left, before));
    return !given_up;
  });
  if (given_up) throw IncompleteError("the job was given up");
  return simplifier.mesh();
}

}  // namespace

JobOutput reduce_piece(const Job& job, const JobContext& context) {
  const ReduceParameters parameters = decode_reduce_parameters(job.parameters);
  if (job.inputs.size() != 1) throw DataError("a reduce job takes one piece");
  ResultMesh piece =
      decode_result(context.read_section(job, 0), parameters.rung, job.inputs[0].name);
  const std::uint32_t locked = piece.boundary_vertices;
  const PositionType positions = piece.positions;
  Mesh mesh = parameters.triangles == k_keep_all ? std::move(piece.mesh)
                                                 : reduced(std::move(piece), parameters, context);
  if (job.sections.size() > 1) {
    fit_vertices(mesh, decode_samples(context.read_section(job, 1), job.inputs[0].name),
                 fit_options(parameters.lines, positions, locked, 1));
  }
  std::string file;
  SectionWriter sections([&](std::string_view bytes) { file += bytes; });
  FinishedPiece made;
  made.mesh = sections.add(encode_piece(mesh, locked, positions));
  made.points = sections.add(encode_list(points_of_piece(mesh, parameters, made)));
  made.vertices = mesh.positions.size();
  made.triangles = mesh.triangles.size();
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, file), encode_summary(made)};
}

}  // namespace meshfarm
