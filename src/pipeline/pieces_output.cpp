// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/pieces_output.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/geometry/weighted_values.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

std::string read_of(const Stage& stage, const FileRef& file, const FileSection& section) {
  return SectionedFile(stage, file).read(section);
}

class PiecesWriter {
 public:
  PiecesWriter(const Stage& stage, const FinishedPieces& result, MeshSink& sink)
      : stage_(stage), result_(result), sink_(sink) {
    std::uint64_t next = 0;
    for (const PieceOfResult& each : result.pieces) {
      first_vertex_.push_back(next);
      if (each.parts == 0) add_shared(each, next);
      next += each.finished.vertices;
    }
    std::sort(shared_.begin(), shared_.end());
  }

  void write(const std::function<void()>& check_stop) {
    for (std::size_t i = 0; i < result_.pieces.size(); ++i) {
      check_stop();
      vertices(i);
    }
    for (std::size_t i = 0; i < result_.pieces.size(); ++i) {
      check_stop();
      triangles(i);
    }
  }

 private:
  void vertices(std::size_t piece) { sink_.vertices(mesh_of(piece).mesh.positions); }

  /// The mesh, then the gap to the surroundings, or to other groups of them.
  void triangles(std::size_t i) {
    const PieceOfResult& piece = result_.pieces[i];
    const ResultMesh mesh = mesh_of(i);
    put(mesh.mesh.triangles, mesh.mesh.columns,
        [&](std::uint32_t v) { return first_vertex_[i] + v; });
    const std::uint32_t locked = mesh.boundary_vertices;
    PieceGap gap =
        decode_gap(read_of(stage_, piece.divided_file, piece.divided.gap), piece.divided_file.name);
    if (gap.triangles.size() < piece.divided.gap_triangles) {
      throw DataError(piece.divided_file.name + ": has other triangles than its summary says");
    }
    gap.triangles.resize(piece.divided.gap_triangles);
    gap.columns.resize(piece.divided.gap_triangles);
    put(gap.triangles, gap.columns, [&](std::uint32_t v) {
      return v < locked ? first_vertex_[i] + v : place_of(gap, v - locked, piece.divided_file.name);
    });
  }

  /// A vertex that groups share, and which it is of the result.
  using SharedPlace = std::pair<SeamVertex, std::uint64_t>;

  void add_shared(const PieceOfResult& group, std::uint64_t first) {
    const std::string& name = group.divided_file.name;
    for (const SeamVertex& each :
         decode_list<SeamVertex>(read_of(stage_, group.divided_file, group.divided.strip), name)) {
      shared_.emplace_back(each, first++);
    }
  }

  std::uint64_t place_of(const PieceGap& gap, std::uint32_t v, const std::string& what) const {
    if (v < gap.vertices.size()) {
      const auto at =
          std::lower_bound(shared_.begin(), shared_.end(), SharedPlace(gap.vertices[v], 0));
      if (at != shared_.end() && at->first == gap.vertices[v]) return at->second;
    }
    throw DataError(what + ": a gap names a vertex that is not there");
  }

  ResultMesh mesh_of(std::size_t i) const {
    const PieceOfResult& piece = result_.pieces[i];
    ResultMesh mesh = decode_result(read_of(stage_, piece.finished_file, piece.finished.mesh), 0,
                                    piece.finished_file.name);
    if (mesh.mesh.positions.size() != piece.finished.vertices) {
      throw DataError(piece.finished_file.name + ": has other vertices than its summary says");
    }
    return mesh;
  }

  template <class Number>
  void put(const std::vector<Triangle>& triangles, const TriangleColumnsView& columns,
           const Number& number) {
    constexpr std::size_t k_put_at_once = 65'536;
    std::vector<WideTriangle> wide;
    for (std::size_t first = 0; first < triangles.size(); first += k_put_at_once) {
      const std::size_t end = std::min(triangles.size(), first + k_put_at_once);
      wide.clear();
      for (std::size_t i = first; i < end; ++i) {
        const auto& [a, b, c] = triangles[i];
        wide.push_back({number(a), number(b), number(c)});
      }
      sink_.triangles(TriangleView{wide, columns.part(first, end - first)});
    }
  }

  const Stage& stage_;
  const FinishedPieces& result_;
  MeshSink& sink_;
  std::vector<std::uint64_t> first_vertex_;
  std::vector<SharedPlace> shared_;  // ascending
};

/// Takes all into memory.
class MeshInMemory : public MeshSink {
 public:
  void vertices(std::span<const Vec3> batch) override {
    mesh_.positions.insert(mesh_.positions.end(), batch.begin(), batch.end());
  }
  void vertices(std::span<const Vec3> batch, std::span<const float> /*values*/) override {
    vertices(batch);
  }
  void triangles(const TriangleView& batch) override {
    for (const auto& [a, b, c] : batch.corners) {
      mesh_.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                 static_cast<std::uint32_t>(c)});
    }
    mesh_.columns.append(batch.columns);
  }
  void triangles(std::span<const Triangle> batch, const TriangleColumnsView& columns) override {
    mesh_.triangles.insert(mesh_.triangles.end(), batch.begin(), batch.end());
    mesh_.columns.append(columns);
  }
  void commit() override {}
  void reserve(const FinishedPieces& result) {
    mesh_.positions.reserve(result.vertices());
    mesh_.triangles.reserve(result.triangles());
  }
  Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
};

/// `lists`: of the points of these pieces.
void take_least(const std::vector<std::vector<double>>& lists, const std::vector<std::size_t>& of,
                const std::string& what, std::vector<std::vector<double>>& least) {
  if (lists.size() != of.size()) throw DataError(what + ": is of other pieces");
  for (std::size_t list = 0; list < lists.size(); ++list) {
    std::vector<double>& known = least[of[list]];
    if (known.empty()) known.assign(lists[list].size(), HUGE_VAL);
    if (known.size() != lists[list].size()) throw DataError(what + ": is of other points");
    for (std::size_t p = 0; p < known.size(); ++p) known[p] = std::min(known[p], lists[list][p]);
  }
}

using WeightedDistances = std::vector<std::pair<double, double>>;

/// What the measure jobs of all pieces found.
struct FoundDistances {
  /// Of the points of each piece, the distances to the nearest of the input that any piece has.
  std::vector<std::vector<double>> to_input;
  /// From the samples of each piece, with the areas that they stand for.
  std::vector<WeightedDistances> to_output;
};

FoundDistances found_distances(const Stage& stage, const FinishedPieces& result) {
  const std::size_t count = result.pieces.size();
  FoundDistances found{std::vector<std::vector<double>>(count),
                       std::vector<WeightedDistances>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<std::size_t> of = {i};
    for (const std::size_t near : result.near(i)) of.push_back(near);
    for (const FileRef& file : result.pieces[i].error_files) {
      const MeasuredPoints points = decode_measured_points(stage.read(file), file.name);
      take_least(points.to_input, of, file.name, found.to_input);
      for (std::size_t p = 0; p < points.areas.size(); ++p) {
        found.to_output[i].emplace_back(points.to_output[p], points.areas[p]);
      }
    }
  }
  return found;
}

DistanceQuantiles quantiles(WeightedDistances distances) {
  WeightedValues values(std::move(distances));
  return {values.quantile(0.95), values.quantile(0.99)};
}

/// Those that are not known are measured to all of the input.
void find_missing(const Stage& stage, const Manifest& manifest, const PieceOfResult& seams,
                  const FinishedPieces& result, unsigned threads, std::vector<double>& distances) {
  if (std::find(distances.begin(), distances.end(), HUGE_VAL) == distances.end()) return;
  const std::vector<Vec3> points = decode_list<Vec3>(
      read_of(stage, seams.finished_file, seams.finished.points), seams.finished_file.name);
  std::vector<Vec3> missing;
  for (std::size_t i = 0; i < std::min(points.size(), distances.size()); ++i) {
    if (distances[i] == HUGE_VAL) missing.push_back(points[i]);
  }
  std::vector<Vec3> known;
  double area = 0;
  for (const PieceOfResult& piece : result.pieces) {
    area += piece.error.input_area;
    for (const SurfaceSamples& each : decode_samples(
             read_of(stage, piece.divided_file, piece.divided.samples), piece.divided_file.name)) {
      known.insert(known.end(), each.points.begin(), each.points.end());
    }
  }
  const double spacing =
      std::sqrt(2 * area / static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles())));
  PointMeter meter(missing, {spacing, spacing, known});
  InputSurface input(stage, manifest, threads);
  while (meter.begin_pass()) {
    input.show([&](const Box& box) { return meter.wants(box); },
               [&](const SurfacePiece& piece) { meter.show(piece.positions, piece.triangles); });
  }
  const std::vector<double> found = meter.distances();
  std::size_t next = 0;
  for (double& d : distances) {
    if (d == HUGE_VAL && next < found.size()) d = found[next++];
  }
}

/// Adds what stands for so much of an area.
void add_error(const Distance& of_piece, double area, Distance& sums) {
  sums.rms += area * of_piece.rms * of_piece.rms;
  sums.mean += area * of_piece.mean;
  sums.max = std::max(sums.max, of_piece.max);
}

Distance error_of(const Distance& sums, double area) {
  if (!(area > 0)) return {};
  return {std::sqrt(sums.rms / area), sums.mean / area, sums.max};
}

Distance error_of_points(const std::vector<double>& distances, std::uint64_t by_area) {
  Distance sums;
  const std::size_t counted = std::min<std::size_t>(by_area, distances.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    sums.max = std::max(sums.max, distances[i]);
    if (i >= counted) continue;
    sums.rms += distances[i] * distances[i];
    sums.mean += distances[i];
  }
  if (counted == 0) return sums;
  const auto count = static_cast<double>(counted);
  return {std::sqrt(sums.rms / count), sums.mean / count, sums.max};
}

}  // namespace

void write_pieces(const Stage& stage, const Manifest& manifest, const FinishedPieces& result,
                  const MeshOutput& output, const std::function<void()>& check_stop) {
  const auto sink = create_mesh(output, {.vertices = result.vertices(),
                                         .triangles = result.triangles(),
                                         .positions = manifest.positions,
                                         .comment = {},
                                         .packing = output.packing});
  PiecesWriter(stage, result, *sink).write(check_stop);
  sink->commit();
}

Mesh mesh_of_pieces(const Stage& stage, const FinishedPieces& result,
                    const std::function<void()>& check_stop) {
  if (result.vertices() > UINT32_MAX) {
    throw DataError("a result of " + std::to_string(result.vertices()) +
                    " vertices is too large for its colours or textures: ask for fewer triangles, "
                    "or leave them out with --attributes none");
  }
  MeshInMemory mesh;
  mesh.reserve(result);
  PiecesWriter(stage, result, mesh).write(check_stop);
  return mesh.take();
}

MeasuredError error_of_pieces(const Stage& stage, const Manifest& manifest,
                              const FinishedPieces& result, unsigned threads,
                              std::vector<ErrorOfPiece>& of_pieces) {
  MeasuredError error;
  double input_area = 0;
  double area = 0;
  Distance to_output;
  Distance to_input;
  for (const PieceOfResult& piece : result.pieces) {
    add_error(piece.error.to_output, piece.error.input_area, to_output);
    input_area += piece.error.input_area;
    error.input_samples += piece.error.input_samples;
    error.output_samples += piece.finished.by_area;
  }
  FoundDistances found = found_distances(stage, result);
  std::vector<std::vector<double>>& distances = found.to_input;
  for (std::size_t i = 0; i < result.pieces.size(); ++i) {
    if (result.pieces[i].parts > 0) continue;
    find_missing(stage, manifest, result.pieces[i], result, threads, distances[i]);
  }
  WeightedDistances all_to_output;
  WeightedDistances all_to_input;
  for (std::size_t i = 0; i < result.pieces.size(); ++i) {
    const PieceOfResult& piece = result.pieces[i];
    const Distance of_piece = error_of_points(distances[i], piece.finished.by_area);
    add_error(of_piece, piece.finished.area, to_input);
    area += piece.finished.area;
    const std::size_t counted = std::min<std::size_t>(piece.finished.by_area, distances[i].size());
    const double of_point = piece.finished.area / static_cast<double>(counted);
    for (std::size_t p = 0; p < counted; ++p) all_to_input.emplace_back(distances[i][p], of_point);
    all_to_output.insert(all_to_output.end(), found.to_output[i].begin(), found.to_output[i].end());
    of_pieces.push_back({piece.first_part, piece.parts, piece.finished.triangles,
                         piece.error.to_output, of_piece, quantiles(std::move(found.to_output[i])),
                         quantiles_of(std::span(distances[i]).first(counted))});
  }
  error.to_output_quantiles = quantiles(std::move(all_to_output));
  error.to_input_quantiles = quantiles(std::move(all_to_input));
  error.to_output = error_of(to_output, input_area);
  error.to_input = error_of(to_input, area);
  return error;
}

}  // namespace meshfarm
