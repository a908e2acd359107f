// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/error_meter.hpp"
#include "pipeline/piece_input.hpp"
#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

/// As the sink does (error_meter.cpp).
constexpr double k_usual_in_rms = 4;
constexpr double k_usual_in_spacings = 4;
/// Of a piece's box, round it: there are the surroundings' points that its input may be near to.
constexpr double k_margin_of_box = 0.05;

/// About, by so many of its triangles.
double spacing_of(const Mesh& mesh) {
  constexpr std::size_t k_looked_at = 10'000;
  const std::size_t step = mesh.triangles.size() / k_looked_at + 1;
  double sum = 0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step, ++count) {
    const auto& [a, b, c] = mesh.triangles[i];
    sum += length(mesh.positions[b] - mesh.positions[a]);
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

void append_every(std::span<const Vec3> points, std::uint64_t step, std::vector<Vec3>& to) {
  for (std::uint64_t i = 0; i < points.size(); i += step) to.push_back(points[i]);
}

/// So many of a surface's vertices bound the distances to it.
constexpr std::size_t k_known_points = 1000;

/// Of a surface that is in memory.
std::vector<double> distances_to(const std::vector<const Mesh*>& surface,
                                 const std::vector<Vec3>& points) {
  std::vector<Vec3> some;
  double spacing = 0;
  for (const Mesh* mesh : surface) {
    append_every(mesh->positions, mesh->positions.size() / k_known_points + 1, some);
    spacing = std::max(spacing, spacing_of(*mesh));
  }
  if (some.empty() || points.empty()) return {};
  PointMeter meter(points, {spacing, spacing / 2, some});
  while (meter.begin_pass()) {
    for (const Mesh* mesh : surface) meter.show(mesh->positions, mesh->triangles);
  }
  return meter.distances();
}

/// Some of the points of several pieces, and where they stand.
struct NearPoints {
  struct Place {
    std::size_t list = 0;
    std::size_t number = 0;
  };
  std::vector<Vec3> points;
  std::vector<Place> places;
};

/// Of all lists but the first.
NearPoints points_near(const std::vector<std::vector<Vec3>>& lists, const Box& box) {
  const double margin = k_margin_of_box * box.diagonal();
  const auto is_within = [margin](double x, double lo, double hi) {
    return x >= lo - margin && x <= hi + margin;
  };
  NearPoints near;
  for (std::size_t list = 1; list < lists.size(); ++list) {
    for (std::size_t i = 0; i < lists[list].size(); ++i) {
      const Vec3& p = lists[list][i];
      if (!is_within(p.x, box.lo.x, box.hi.x) || !is_within(p.y, box.lo.y, box.hi.y) ||
          !is_within(p.z, box.lo.z, box.hi.z)) {
        continue;
      }
      near.points.push_back(p);
      near.places.push_back({list, i});
    }
  }
  return near;
}

/// Corners of the gap become those of the mesh, and new vertices.
void append_gap(const PieceGap& gap, std::uint32_t shared, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), gap.positions.begin(), gap.positions.end());
  for (const Triangle& t : gap.triangles) {
    Triangle& added = mesh.triangles.emplace_back(t);
    for (std::uint32_t& v : added) {
      if (v >= shared) v += first - shared;
      if (v >= mesh.positions.size()) throw DataError("a gap names a vertex that is not there");
    }
  }
}

class PieceMeter {
 public:
  PieceMeter(const MeasureParameters& parameters, const JobContext& context)
      : parameters_(parameters), context_(context), mesh_(read_mesh_of_piece()) {
    surface_.push_back(&mesh_);
    if (parameters.seam_mesh.file.name.empty()) return;
    seam_mesh_ = mesh_of(parameters.seam_mesh);
    surface_.push_back(&seam_mesh_);
  }

  PieceError run() {
    measure_samples();
    is_piece() ? measure_to_parts() : measure_to_seams();
    return error_;
  }
  const std::vector<std::vector<double>>& to_input() const { return to_input_; }

 private:
  bool is_piece() const { return parameters_.end_part > parameters_.first_part; }

  Mesh mesh_of(const SectionRef& ref) const {
    return decode_result(read_section(context_, ref), 0, ref.file.name).mesh;
  }

  std::vector<std::vector<Vec3>> read_points() const {
    std::vector<std::vector<Vec3>> points;
    for (const SectionRef& ref : parameters_.points) {
      points.push_back(decode_points(read_section(context_, ref), ref.file.name));
    }
    return points;
  }

  /// With the triangles between it and the surroundings.
  Mesh read_mesh_of_piece() const {
    const SectionRef& ref = parameters_.mesh;
    const ResultMesh piece = decode_result(read_section(context_, ref), 0, ref.file.name);
    Mesh mesh = piece.mesh;
    if (!is_piece()) return mesh;
    const PieceGap gap =
        decode_gap(read_section(context_, parameters_.gap), parameters_.gap.file.name);
    append_gap(gap, piece.boundary_vertices, mesh);
    return mesh;
  }

  void measure_samples() {
    const std::vector<SurfaceSamples> samples =
        decode_samples(read_section(context_, parameters_.samples), parameters_.samples.file.name);
    std::vector<Vec3> points;
    for (const SurfaceSamples& each : samples) append_every(each.points, 1, points);
    const std::vector<double> distances = distances_to(surface_, points);
    if (distances.empty()) return;
    std::size_t first = 0;
    for (const SurfaceSamples& each : samples) {
      if (each.points.empty()) continue;
      const Distance d = distance_of(std::span(distances).subspan(first, each.points.size()));
      first += each.points.size();
      error_.input_area += each.area;
      error_.to_output.rms += each.area * d.rms * d.rms;
      error_.to_output.mean += each.area * d.mean;
      error_.to_output.max = std::max(error_.to_output.max, d.max);
    }
    error_.input_samples = points.size();
    if (!(error_.input_area > 0)) return;
    error_.to_output.rms = std::sqrt(error_.to_output.rms / error_.input_area);
    error_.to_output.mean /= error_.input_area;
  }

  /// The farthest that is looked for at first.
  double usual(double spacing) const {
    const Distance& d = error_.to_output;
    return std::max(std::min(k_usual_in_rms * d.rms, k_usual_in_spacings * spacing),
                    std::min(2 * d.max, spacing));
  }

  /// The piece's own points are as near as they are; others may be nearer to what other pieces
  /// have.
  void measure_to_parts() {
    const std::vector<std::vector<Vec3>> points = read_points();
    const NearPoints near = points_near(points, parameters_.box);
    PieceInput input(context_.stage, parameters_);
    const std::vector<Vec3> known = known_points();
    const auto triangles = static_cast<double>(std::max<std::uint64_t>(1, parameters_.triangles));
    const double spacing = std::sqrt(2 * error_.input_area / triangles);
    // Hardly a point is as far as triangles of the result are long.
    const double reach = std::max({2 * error_.to_output.max, spacing, spacing_of(mesh_)});
    PointMeter own(points.front(), {spacing, usual(spacing), known});
    PointMeter to_near(near.points, {spacing, reach, known});
    std::vector<Vec3> vertices;
    to_near.begin_pass();
    for (bool is_first = true; own.begin_pass() || is_first; is_first = false) {
      const auto show = [&](const Mesh& mesh) {
        own.show(mesh.positions, mesh.triangles);
        if (is_first) to_near.show(mesh.positions, mesh.triangles);
        if (!context_.progress(mesh.triangles.size())) {
          throw IncompleteError("the job was given up");
        }
      };
      const auto show_part = [&](const Mesh& mesh) {
        show(mesh);
        if (is_first) add_vertices(mesh, vertices);
      };
      input.show([&](const Box& box) { return own.wants(box); }, show_part, show);
    }
    for (const std::vector<Vec3>& each : points) to_input_.emplace_back(each.size(), HUGE_VAL);
    to_input_.front() = own.distances();
    const std::vector<double> found = to_near.distances();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] < reach) to_input_[near.places[i].list][near.places[i].number] = found[i];
    }
    for (const double d : distances_to(surface_, vertices)) {
      error_.to_output.max = std::max(error_.to_output.max, d);
    }
  }

  void add_vertices(const Mesh& part, std::vector<Vec3>& vertices) const {
    append_every(part.positions, parameters_.input_step, vertices);
    if (parameters_.input_step > 1) return;
    append_every(middles_of_longest_sides(part.positions, part.triangles), 1, vertices);
  }

  /// The input's triangles between pieces are in memory.
  void measure_to_seams() {
    const std::vector<Vec3> points = read_points().front();
    const Mesh between =
        decode_surface(read_section(context_, parameters_.gap), parameters_.gap.file.name);
    to_input_.push_back(distances_to({&between}, points));
    to_input_.front().resize(points.size(), HUGE_VAL);
  }

  /// The distance to the nearest of these is no less than that to the input's surface.
  std::vector<Vec3> known_points() const {
    const std::vector<SurfaceSamples> samples =
        decode_samples(read_section(context_, parameters_.samples), parameters_.samples.file.name);
    std::vector<Vec3> known;
    for (const SurfaceSamples& each : samples) append_every(each.points, 1, known);
    if (known.empty()) throw DataError(parameters_.samples.file.name + ": has no samples");
    return known;
  }

  const MeasureParameters& parameters_;
  const JobContext& context_;
  Mesh mesh_;
  Mesh seam_mesh_;
  std::vector<const Mesh*> surface_;  // of the result
  PieceError error_;
  std::vector<std::vector<double>> to_input_;
};

}  // namespace

JobOutput measure_piece(const Job& job, const JobContext& context) {
  const MeasureParameters parameters = decode_measure_parameters(job.parameters);
  PieceMeter meter(parameters, context);
  const PieceError error = meter.run();
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, encode_distances(meter.to_input())), encode_summary(error)};
}

}  // namespace meshfarm
