// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/error_meter.hpp"
#include "pipeline/piece_input.hpp"
#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

/// How far the first pass looks, limited as in error_meter.cpp. Only the time depends on it.
constexpr double k_usual_in_rms = 4;
constexpr double k_usual_in_spacings = 4;

/// Approximate spacing, from k_looked_at of its triangles.
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

double squared_distance(const Vec3& p, const Box& box) {
  const auto beyond = [](double x, double lo, double hi) {
    return std::max({lo - x, x - hi, 0.0});
  };
  const Vec3 d = {beyond(p.x, box.lo.x, box.hi.x), beyond(p.y, box.lo.y, box.hi.y),
                  beyond(p.z, box.lo.z, box.hi.z)};
  return dot(d, d);
}

/// Some of the points of several pieces, and their places in the lists.
struct SomePoints {
  struct Place {
    std::size_t list = 0;
    std::size_t number = 0;
  };
  std::vector<Vec3> points;
  std::vector<Place> places;

  void add(const std::vector<std::vector<Vec3>>& lists, std::size_t list, std::size_t number) {
    points.push_back(lists[list][number]);
    places.push_back({list, number});
  }
};

/// Takes points from all lists but the first.
SomePoints points_near(const std::vector<std::vector<Vec3>>& lists, const Box& box, double margin) {
  SomePoints near;
  for (std::size_t list = 1; list < lists.size(); ++list) {
    for (std::size_t i = 0; i < lists[list].size(); ++i) {
      if (squared_distance(lists[list][i], box) < margin * margin) near.add(lists, list, i);
    }
  }
  return near;
}

/// Takes those points of the first list to which something in the box may be nearer than the known
/// points of the surface.
SomePoints points_that_want(const std::vector<std::vector<Vec3>>& lists, const Box& box,
                            const PointMeterHints& hints) {
  PointMeter meter(lists.front(), hints);
  while (meter.begin_pass()) {
  }
  const std::vector<double> bounds = meter.distances();
  SomePoints some;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (squared_distance(lists.front()[i], box) <= bounds[i] * bounds[i]) some.add(lists, 0, i);
  }
  return some;
}

/// Corners of the gap become vertices of the mesh, shared or new.
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
      : parameters_(parameters), context_(context) {
    surface_ = read_mesh({parameters.mesh, parameters.gap});
    triangle_size_ = spacing_of(surface_);
    for (const SeamSurface& each : parameters.seams) {
      const Mesh seam = read_mesh(each);
      append_surface(seam.positions, seam.triangles, surface_);
    }
    if (!surface_.triangles.empty()) to_surface_.emplace(surface_, 1);
  }

  PieceError run() {
    measure_samples();
    is_piece() ? measure_to_input() : measure_to_seams();
    return error_;
  }
  const MeasuredPoints& points() const { return points_; }

 private:
  bool is_piece() const { return parameters_.triangles > 0; }

  std::vector<std::vector<Vec3>> read_points() const {
    std::vector<std::vector<Vec3>> points;
    for (const SectionRef& ref : parameters_.points) {
      points.push_back(decode_list<Vec3>(read_section(context_, ref), ref.file.name));
    }
    return points;
  }

  /// Reads a mesh with the triangles between it and others.
  Mesh read_mesh(const SeamSurface& from) const {
    const SectionRef& ref = from.mesh;
    ResultMesh piece = decode_result(read_section(context_, ref), 0, ref.file.name);
    const PieceGap gap = decode_gap(read_section(context_, from.gap), from.gap.file.name);
    append_gap(gap, piece.boundary_vertices, piece.mesh);
    return std::move(piece.mesh);
  }

  void measure_samples() {
    const std::vector<SurfaceSamples> samples =
        decode_samples(read_section(context_, parameters_.samples), parameters_.samples.file.name);
    std::vector<Vec3> points;
    std::uint64_t all = 0;
    for (const SurfaceSamples& each : samples) {
      area_ += each.area;
      all += each.points.size();
    }
    // Consecutive samples: sets belong to neighbouring parts.
    const std::uint64_t begin = all * parameters_.share / parameters_.shares;
    const std::uint64_t end = all * (parameters_.share + 1) / parameters_.shares;
    std::vector<std::size_t> counts;  // per set
    std::uint64_t number = 0;
    for (const SurfaceSamples& each : samples) {
      const std::size_t before = points.size();
      for (const Vec3& p : each.points) {
        if (number >= begin && number < end) points.push_back(p);
        ++number;
      }
      counts.push_back(points.size() - before);
    }
    if (!to_surface_) return;
    std::vector<DistanceMeter::Points> sets;
    std::size_t first = 0;
    for (const std::size_t count : counts) {
      sets.emplace_back(std::span(points).subspan(first, count));
      first += count;
    }
    points_.to_output.resize(points.size());
    const std::vector<Distance> distances = to_surface_->measure_each(sets, points_.to_output);
    for (std::size_t set = 0; set < samples.size(); ++set) {
      if (counts[set] == 0) continue;
      const Distance& d = distances[set];
      const double of_point = samples[set].area / static_cast<double>(samples[set].points.size());
      points_.areas.insert(points_.areas.end(), counts[set], of_point);
      const double area = of_point * static_cast<double>(counts[set]);
      error_.input_area += area;
      error_.to_output.rms += area * d.rms * d.rms;
      error_.to_output.mean += area * d.mean;
      error_.to_output.max = std::max(error_.to_output.max, d.max);
    }
    error_.input_samples = points.size();
    if (!(error_.input_area > 0)) return;
    error_.to_output.rms = std::sqrt(error_.to_output.rms / error_.input_area);
    error_.to_output.mean /= error_.input_area;
  }

  /// The largest distance that the first pass looks for.
  double usual(double spacing) const {
    const Distance& d = error_.to_output;
    return std::max(std::min(k_usual_in_rms * d.rms, k_usual_in_spacings * spacing),
                    std::min(2 * d.max, spacing));
  }

  /// The piece's own points are nearest to what one of its jobs has, however far that is; other
  /// points may be nearer to what other pieces have.
  void measure_to_input() {
    const PieceInput input = read_piece_input(context_.stage, parameters_);
    const std::vector<std::vector<Vec3>> points = read_points();
    const std::vector<Vec3> known = known_points();
    const auto triangles = static_cast<double>(parameters_.triangles);
    const double spacing = std::sqrt(2 * area_ / triangles);
    // Hardly any point is farther away than the triangles of the result are long.
    const double reach = std::max({2 * error_.to_output.max, spacing, triangle_size_});
    const SomePoints near = points_near(points, input.box, reach);
    const SomePoints own = points_that_want(points, input.box, {spacing, usual(spacing), known});
    for (const std::vector<Vec3>& each : points)
      points_.to_input.emplace_back(each.size(), HUGE_VAL);
    PointMeter to_own(own.points, {spacing, usual(spacing), known});
    while (to_own.begin_pass()) show(input, to_own);
    take_found(own, to_own.distances(), HUGE_VAL);
    // If a part was left out, the reach is long, and a first pass that went that far would be slow.
    const double first_reach = std::min(reach, 2 * triangle_size_ + spacing);
    PointMeter to_near(near.points, {spacing, first_reach, known});
    if (to_near.begin_pass()) show(input, to_near);
    if (reach > first_reach && to_near.begin_pass()) show(input, to_near);
    take_found(near, to_near.distances(), reach);
    if (to_surface_) error_.to_output.max = farthest_of(input.parts);
  }

  double farthest_of(const std::vector<Mesh>& parts) const {
    double farthest = error_.to_output.max;
    for (const Mesh& part : parts) {
      std::vector<Vec3> points;
      append_every(vertices_of_surface(part.positions, part.triangles), parameters_.input_step,
                   points);
      if (parameters_.with_sides) {
        append_every(middles_of_longest_sides(part.positions, part.triangles), 1, points);
      }
      farthest = to_surface_->farthest(points, farthest);
    }
    return farthest;
  }

  void show(const PieceInput& input, PointMeter& meter) const {
    for (const Mesh& part : input.parts) show(part, meter);
    show(input.between, meter);
  }

  void show(const Mesh& mesh, PointMeter& meter) const {
    meter.show(mesh.positions, mesh.triangles);
    if (!context_.progress(mesh.triangles.size())) throw IncompleteError("the job was given up");
  }

  void take_found(const SomePoints& some, const std::vector<double>& found, double below) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] < below) points_.to_input[some.places[i].list][some.places[i].number] = found[i];
    }
  }

  /// The input's triangles between pieces are in memory.
  void measure_to_seams() {
    const std::vector<Vec3> points = read_points().front();
    const Mesh between =
        decode_surface(read_section(context_, parameters_.between), parameters_.between.file.name);
    std::vector<double>& to_input = points_.to_input.emplace_back(points.size(), HUGE_VAL);
    if (between.triangles.empty()) return;
    const DistanceMeter::Points all = points;
    DistanceMeter(between, 1).measure_each({&all, 1}, to_input);
  }

  /// The distance to the nearest of these is an upper bound on the distance to the input's surface.
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
  Mesh surface_;              // the piece of the result, and the seams near it
  double triangle_size_ = 0;  // of the piece, from the sides of its triangles
  std::optional<DistanceMeter> to_surface_;
  PieceError error_;
  double area_ = 0;  // of the piece's input
  MeasuredPoints points_;
};

}  // namespace

JobOutput measure_piece(const Job& job, const JobContext& context) {
  const MeasureParameters parameters = decode_measure_parameters(job.parameters);
  PieceMeter meter(parameters, context);
  const PieceError error = meter.run();
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, encode_points(meter.points())), encode_summary(error)};
}

}  // namespace meshfarm
