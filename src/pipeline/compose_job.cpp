// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/compose_job.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"
#include "pipeline/rung_input.hpp"

namespace meshfarm {
namespace {

// Version 6: first part u32 | all parts u32 | inputs u32 x (parts u32 | rung u32) |
// boundary (io/boundary_ref.hpp) | level i32 | greatest cost f64 | floor u64 |
// samples a triangle f64 | keeps between u8 | lines (run_options.hpp). Version 4 kept nothing,
// version 5 had one boundary file.
constexpr std::uint8_t k_compose_version = 6;
constexpr double k_max_samples_per_triangle = 1000;

class Composer {
 public:
  Composer(const Job& job, const JobContext& context)
      : job_(job),
        context_(context),
        parameters_(decode_compose_parameters(job.parameters)),
        rungs_(job, context),
        stitcher_(parameters_.all_parts, parameters_.first_part) {
    if (job.inputs.size() != parameters_.inputs.size()) {
      throw DataError("a compose job has other inputs than its parameters name");
    }
  }

  JobOutput run() {
    for (std::size_t i = 0; i < job_.inputs.size(); ++i) add(i);
    const Seams seams = read_seams();
    StitchedMesh stitched = stitcher_.finish(seams.triangles, seams.columns);
    sample_seams(stitched);
    if (parameters_.keeps_between) append_surface_of(last_triangles(stitched));
    put_open_first(stitched);
    const auto locked = static_cast<std::uint32_t>(stitched.open.size());
    Simplifier simplifier(std::move(stitched.mesh), {.locked_vertices = locked,
                                                     .positions = positions_,
                                                     .opened = std::move(stitched.opened),
                                                     .lines = parameters_.lines,
                                                     .was_simplified = true});
    simplify(simplifier);
    return write(simplifier, locked);
  }

 private:
  void add(std::size_t i) {
    ResultMesh result = rungs_.next(parameters_.inputs[i].rung);
    positions_ = result.positions;
    stitcher_.add(result, parameters_.inputs[i].parts);
    std::move(result.samples.begin(), result.samples.end(), std::back_inserter(samples_));
    if (!parameters_.keeps_between || parameters_.inputs[i].parts == 1) return;
    append_surface_of(decode_surface(rungs_.beside(), job_.inputs[i].name));
  }

  void append_surface_of(const Mesh& more) {
    append_surface(more.positions, more.triangles, between_);
  }

  /// The boundary triangles that touch the group.
  struct Seams {
    std::vector<BoundaryTriangle> triangles;
    TriangleColumns columns;
  };
  Seams read_seams() const {
    std::vector<PartRange> pieces;
    std::uint32_t end = parameters_.first_part;
    for (const ComposeInput& input : parameters_.inputs) {
      const std::uint32_t first = std::exchange(end, end + input.parts);
      pieces.push_back({first, end});
    }
    BoundaryRegions regions(context_.stage, parameters_.boundary, parameters_.all_parts);
    Seams seams;
    for (const std::uint32_t region : Regions(parameters_.all_parts).touched_by(pieces)) {
      regions.read(region, seams.triangles, seams.columns);
    }
    const auto is_ours = [&](const BoundaryCorner& corner) {
      return corner.part >= parameters_.first_part && corner.part < end;
    };
    keep_triangles(seams.triangles, seams.columns, [&](std::size_t i) {
      return std::any_of(seams.triangles[i].begin(), seams.triangles[i].end(), is_ours);
    });
    seams.columns.keep(parameters_.lines.columns);
    return seams;
  }

  /// The triangles between parts are still the input's.
  void sample_seams(StitchedMesh& stitched) {
    const auto count = static_cast<std::ptrdiff_t>(stitched.boundary_triangles);
    Mesh seams;
    seams.triangles.assign(stitched.mesh.triangles.end() - count, stitched.mesh.triangles.end());
    const auto wanted = static_cast<std::uint64_t>(
        std::ceil(parameters_.samples_per_triangle * static_cast<double>(count)));
    if (wanted == 0) return;
    std::swap(seams.positions, stitched.mesh.positions);
    samples_.push_back(sample_surface(seams, {.samples = wanted, .threads = 1}));
    std::swap(seams.positions, stitched.mesh.positions);
  }

  /// Renumbers the open vertices to the front, keeping the order otherwise.
  static void put_open_first(StitchedMesh& stitched) {
    Mesh& from = stitched.mesh;
    std::vector<std::uint32_t> number(from.positions.size(), 0);
    Mesh mesh;
    mesh.positions.reserve(from.positions.size());
    for (const std::uint32_t v : stitched.open) append_vertex(VertexView(from), v, mesh);
    for (const std::uint32_t v : stitched.open) number[v] = 1;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] != 0) continue;
      number[v] = static_cast<std::uint32_t>(mesh.positions.size());
      append_vertex(VertexView(from), v, mesh);
    }
    for (std::uint32_t i = 0; i < stitched.open.size(); ++i) number[stitched.open[i]] = i;
    mesh.triangles = std::move(from.triangles);
    mesh.columns = std::move(from.columns);
    renumber_corners(mesh.triangles, number);
    from = std::move(mesh);
    for (std::uint32_t& v : stitched.opened) v = number[v];
    std::sort(stitched.opened.begin(), stitched.opened.end());
  }

  void simplify(Simplifier& simplifier) const {
    const std::uint64_t before = simplifier.triangles();
    bool given_up = false;
    simplifier.reduce({.triangles = parameters_.floor, .max_cost = parameters_.max_cost},
                      [&](std::uint64_t left) {
                        given_up = !context_.progress(before - std::min(left, before));
                        return !given_up;
                      });
    if (given_up) throw IncompleteError("the job was given up");
  }

  JobOutput write(const Simplifier& simplifier, std::uint32_t locked) const {
    std::string file;
    const Mesh& mesh = simplifier.mesh();
    ResultWriter result(
        {positions_, !mesh.appearances.empty(), locked, mesh.columns.set()},
        [&](std::string_view bytes) { file += bytes; },
        parameters_.keeps_between ? encode_surface(between_) : std::string());
    result.add_rung(parameters_.level, mesh, simplifier.free_triangles(), 0, 0,
                    simplifier.opened());
    result.finish(VertexView(mesh).part(0, locked), samples_);
    const ResultName name{key_of(job_).value, context_.attempt, context_.incarnation};
    const ResultSummary summary = result.summary_of(simplifier);
    return {context_.publish(name, file), encode_summary(summary)};
  }

  const Job& job_;
  const JobContext& context_;
  ComposeParameters parameters_;
  RungInputs rungs_;
  Stitcher stitcher_;
  PositionType positions_ = PositionType::float32;
  std::vector<SurfaceSamples> samples_;
  Mesh between_;
};

}  // namespace

std::string encode_parameters(const ComposeParameters& parameters) {
  ByteWriter out;
  out.put(k_compose_version);
  out.put(parameters.first_part);
  out.put(parameters.all_parts);
  out.put(static_cast<std::uint32_t>(parameters.inputs.size()));
  for (const ComposeInput& input : parameters.inputs) {
    out.put(input.parts);
    out.put(input.rung);
  }
  put_boundary(out, parameters.boundary);
  out.put(parameters.level);
  out.put(parameters.max_cost);
  out.put(parameters.floor);
  out.put(parameters.samples_per_triangle);
  out.put(static_cast<std::uint8_t>(parameters.keeps_between ? 1 : 0));
  put(out, parameters.lines);
  return out.take();
}

ComposeParameters decode_compose_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a compose job");
  if (in.get<std::uint8_t>() != k_compose_version) in.fail("made by another version of meshfarm");
  ComposeParameters parameters;
  parameters.first_part = in.get<std::uint32_t>();
  parameters.all_parts = in.get<std::uint32_t>();
  const auto inputs = in.get<std::uint32_t>();
  std::uint64_t end = parameters.first_part;
  for (std::uint32_t i = 0; i < inputs; ++i) {
    ComposeInput input;
    input.parts = in.get<std::uint32_t>();
    input.rung = in.get<std::uint32_t>();
    end += input.parts;
    if (input.parts == 0 || end > parameters.all_parts) in.fail("impossible parts");
    parameters.inputs.push_back(input);
  }
  parameters.boundary = get_boundary(in);
  parameters.level = in.get<std::int32_t>();
  parameters.max_cost = in.get<double>();
  parameters.floor = in.get<std::uint64_t>();
  parameters.samples_per_triangle = in.get<double>();
  const double samples = parameters.samples_per_triangle;
  if (!(samples >= 0 && samples <= k_max_samples_per_triangle)) in.fail("too many samples");
  parameters.keeps_between = in.get<std::uint8_t>() != 0;
  parameters.lines = get_lines(in);
  in.expect_end();
  return parameters;
}

JobOutput compose_parts(const Job& job, const JobContext& context) {
  return Composer(job, context).run();
}

}  // namespace meshfarm
