// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"
#include "pipeline/rung_input.hpp"
#include "pipeline/seam_bound.hpp"

namespace meshfarm {
namespace {

/// At this many triangles from a seam a piece is as simple as elsewhere.
constexpr int k_strip_rings = 4;
/// The corners of the last ring are locked.
constexpr int k_bounded_strip_rings = k_bounded_rings + 1;

/// The side that each vertex of a piece goes to.
struct Sides {
  std::vector<std::uint8_t> strip;   // per vertex: it leaves
  std::vector<std::uint8_t> shared;  // per vertex: a triangle of it has corners on both sides
};

/// Vertices without triangles stay where they are: the simplifier drops them.
Sides sides_of(const Mesh& mesh, std::uint32_t boundary, int rings) {
  Sides sides;
  sides.strip.assign(mesh.positions.size(), 0);
  std::fill_n(sides.strip.begin(), boundary, std::uint8_t{1});
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<std::uint8_t> before = sides.strip;
    for (const auto& [a, b, c] : mesh.triangles) {
      if ((before[a] | before[b] | before[c]) != 0) {
        sides.strip[a] = sides.strip[b] = sides.strip[c] = 1;
      }
    }
  }
  sides.shared.assign(mesh.positions.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles) {
    const int in_strip = sides.strip[a] + sides.strip[b] + sides.strip[c];
    if (in_strip == 1 || in_strip == 2) sides.shared[a] = sides.shared[b] = sides.shared[c] = 1;
  }
  return sides;
}

/// New numbers for the wanted vertices of a mesh, in order.
class Numbers {
 public:
  explicit Numbers(std::size_t vertices) : of_(vertices, k_left_out) {}
  template <class Wants>
  void add(const Wants& wants) {
    for (std::uint32_t v = 0; v < of_.size(); ++v) {
      if (of_[v] == k_left_out && wants(v)) of_[v] = count_++;
    }
  }
  Mesh place(const Mesh& from) const {
    Mesh mesh;
    place_vertices(VertexView(from), of_, count_, mesh);
    for (std::size_t i = 0; i < from.triangles.size(); ++i) {
      const auto& [a, b, c] = from.triangles[i];
      if (of_[a] != k_left_out && of_[b] != k_left_out && of_[c] != k_left_out) {
        mesh.triangles.push_back({of_[a], of_[b], of_[c]});
        mesh.columns.append(from.columns, i);
      }
    }
    return mesh;
  }
  std::uint32_t operator[](std::uint32_t vertex) const { return of_[vertex]; }
  std::uint32_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> of_;
  std::uint32_t count_ = 0;
};

/// A piece split into three: its mesh, the part that leaves it, and the triangles between the two.
struct SplitMesh {
  Mesh inner;
  std::uint32_t locked = 0;  // the first vertices of the inner mesh
  PieceGap gap;
  PieceStrip strip;
};

SplitMesh split(const ResultMesh& piece, const Sides& sides, std::uint32_t piece_number) {
  const Mesh& mesh = piece.mesh;
  Numbers inner(mesh.positions.size());
  inner.add([&](std::uint32_t v) { return sides.strip[v] == 0 && sides.shared[v] != 0; });
  SplitMesh made;
  made.locked = inner.count();
  inner.add([&](std::uint32_t v) { return sides.strip[v] == 0; });
  made.inner = inner.place(mesh);
  Numbers strip(mesh.positions.size());
  strip.add([&](std::uint32_t v) { return sides.strip[v] != 0; });
  made.strip.mesh = {strip.place(mesh), piece.boundary_vertices, piece.positions, {}};
  std::vector<std::uint32_t> place(mesh.positions.size(), 0);  // among the gap's corners
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    if (sides.shared[v] == 0) continue;
    place[v] = inner[v];
    if (sides.strip[v] == 0) continue;
    place[v] = made.locked + static_cast<std::uint32_t>(made.strip.shared.size());
    made.strip.shared.push_back(strip[v]);
    made.gap.vertices.push_back({piece_number, strip[v]});
    made.gap.positions.push_back(mesh.positions[v]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const int in_strip = sides.strip[a] + sides.strip[b] + sides.strip[c];
    if (in_strip == 1 || in_strip == 2) {
      made.gap.triangles.push_back({place[a], place[b], place[c]});
      made.gap.columns.append(mesh.columns, i);
    }
  }
  return made;
}

/// Keeps the points for fitting that are nearest to what stays in the piece: the others are nearest
/// to what leaves it, and at most second to a sheet that stays.
std::vector<SurfaceSamples> nearest_to_inner(std::vector<SurfaceSamples> points, const Mesh& mesh,
                                             const Sides& sides) {
  if (points.empty() || mesh.triangles.empty()) return {};
  const DistanceMeter meter(mesh, 1);
  for (SurfaceSamples& set : points) {
    if (set.points.empty()) continue;
    const double each = set.area / static_cast<double>(set.points.size());
    const std::vector<std::uint32_t> nearest = meter.nearest_triangles(set.points);
    std::vector<Vec3> inner;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const auto& [a, b, c] = mesh.triangles[nearest[i]];
      if ((sides.strip[a] | sides.strip[b] | sides.strip[c]) == 0) inner.push_back(set.points[i]);
    }
    set = {each * static_cast<double>(inner.size()), std::move(inner)};
  }
  return points;
}

/// Leaves out these components, given by their lowest vertices. Returns their boundary vertices.
std::vector<std::uint32_t> drop_components(const SectionRef& components, const JobContext& context,
                                           ResultMesh& piece) {
  std::vector<std::uint32_t> boundary;
  if (components.file.name.empty()) return boundary;
  Mesh& mesh = piece.mesh;
  std::vector<std::uint8_t> is_dropped(mesh.positions.size(), 0);
  for (const std::uint32_t v :
       decode_list<std::uint32_t>(read_section(context, components), components.file.name)) {
    if (v >= is_dropped.size()) throw DataError(components.file.name + ": no such vertex");
    is_dropped[v] = 1;
  }
  const std::vector<std::uint32_t> lowest = lowest_connected(mesh.positions.size(), mesh.triangles);
  keep_triangles(mesh,
                 [&](std::size_t i) { return is_dropped[lowest[mesh.triangles[i][0]]] == 0; });
  for (std::uint32_t v = 0; v < piece.boundary_vertices; ++v) {
    if (is_dropped[lowest[v]] != 0) boundary.push_back(v);
  }
  return boundary;
}

/// Shared vertices stay locked for the rest of the run, so the piece should be about as simple as
/// the result before that.
void approach(const SplitParameters& parameters, const JobContext& context, ResultMesh& piece,
              DividedPiece& made) {
  if (parameters.step < 0) return;
  const std::uint64_t before = piece.mesh.triangles.size();
  Simplifier simplifier(std::move(piece.mesh), {.locked_vertices = piece.boundary_vertices,
                                                .positions = piece.positions,
                                                .lines = parameters.weigh.lines,
                                                .was_simplified = true});
  bool given_up = false;
  simplifier.reduce({.max_cost = step_cost(parameters.step, parameters.weigh.cost_unit)},
                    [&](std::uint64_t left) {
                      given_up = !context.progress(before - std::min(left, before));
                      return !given_up;
                    });
  if (given_up) throw IncompleteError("the job was given up");
  piece.mesh = simplifier.mesh();
  made.dropped_degenerate = simplifier.dropped_degenerate();
  made.dropped_duplicate = simplifier.dropped_duplicate();
  made.turned = simplifier.turned();
}

}  // namespace

JobOutput split_piece(const Job& job, const JobContext& context) {
  if (job.inputs.size() != 1) throw DataError("a split job takes one piece");
  const SplitParameters parameters = decode_split_parameters(job.parameters);
  RungInputs inputs(job, context);
  ResultMesh piece = inputs.next(parameters.rung);
  const LineOptions& lines = parameters.weigh.lines;
  if (!(lines.appearance_scale.length > 0)) piece.mesh.appearances = {};
  piece.mesh.columns.keep(lines.columns);
  DividedPiece made;
  for (const Vec3& v : piece.mesh.positions) made.box.add(v);
  std::vector<std::uint32_t> dropped = drop_components(parameters.small_components, context, piece);
  approach(parameters, context, piece, made);
  const Sides sides = sides_of(piece.mesh, piece.boundary_vertices,
                               parameters.weigh.is_weighed ? k_strip_rings : k_bounded_strip_rings);
  SplitMesh halves = split(piece, sides, parameters.piece);
  halves.strip.dropped = std::move(dropped);
  PieceFile file;
  SplitSamples samples = split_samples(std::move(piece.samples), parameters.weigh.samples);
  made.samples = file.add(encode_samples(samples.measured));
  made.fitting =
      file.add(encode_samples(nearest_to_inner(std::move(samples.fitting), piece.mesh, sides)));
  if (parameters.is_composed) made.between = file.add(inputs.beside());
  piece = {};
  made.strip_triangles = halves.strip.mesh.mesh.triangles.size();
  made.shared = halves.strip.shared.size();
  made.gap_triangles = halves.gap.triangles.size();
  const PositionType positions = halves.strip.mesh.positions;
  made.strip = file.add(encode_strip(std::exchange(halves.strip, {})));
  made.gap = file.add(encode_gap(std::exchange(halves.gap, {})));
  file.add_weighed(
      weigh(std::move(halves.inner), halves.locked, positions, parameters.weigh, context), made);
  return file.publish(job, context, encode_summary(made));
}

}  // namespace meshfarm
