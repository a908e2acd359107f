// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/pieces_error.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/geometry/weighted_values.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

std::string section_of(const Stage& stage, const FileRef& file, const FileSection& section) {
  return SectionedFile(stage, file).read(section);
}

/// `lists`: distances of the points of the pieces `of`.
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

/// The results of the measure jobs of all pieces.
struct FoundDistances {
  /// For the points of each piece, the distances to the nearest input of any piece.
  std::vector<std::vector<double>> to_input;
  /// From the samples of each piece, with the areas that they represent.
  std::vector<WeightedDistances> to_output;
};

FoundDistances found_distances(const Stage& stage, const FinishedPieces& result, unsigned threads) {
  const std::size_t count = result.pieces.size();
  FoundDistances found{std::vector<std::vector<double>>(count),
                       std::vector<WeightedDistances>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<std::size_t> of = {i};
    for (const std::size_t near : result.near(i)) of.push_back(near);
    const std::vector<FileRef>& files = result.pieces[i].error_files;
    std::vector<MeasuredPoints> points(files.size());
    parallel_for(files.size(), threads, [&](std::uint64_t f) {
      points[f] = decode_measured_points(stage.read(files[f]), files[f].name);
    });
    for (std::size_t f = 0; f < files.size(); ++f) {
      take_least(points[f].to_input, of, files[f].name, found.to_input);
      for (std::size_t p = 0; p < points[f].areas.size(); ++p) {
        found.to_output[i].emplace_back(points[f].to_output[p], points[f].areas[p]);
      }
    }
  }
  return found;
}

DistanceQuantiles quantiles(WeightedDistances distances) {
  WeightedValues values(std::move(distances));
  return {values.quantile(0.95), values.quantile(0.99)};
}

/// Measures unknown distances to the whole input.
void find_missing(const Stage& stage, const Manifest& manifest, const PieceOfResult& seams,
                  const FinishedPieces& result, unsigned threads, std::vector<double>& distances) {
  if (std::find(distances.begin(), distances.end(), HUGE_VAL) == distances.end()) return;
  const std::vector<Vec3> points = decode_list<Vec3>(
      section_of(stage, seams.finished_file, seams.finished.points), seams.finished_file.name);
  std::vector<Vec3> missing;
  for (std::size_t i = 0; i < std::min(points.size(), distances.size()); ++i) {
    if (distances[i] == HUGE_VAL) missing.push_back(points[i]);
  }
  std::vector<Vec3> known;
  double area = 0;
  for (const PieceOfResult& piece : result.pieces) {
    area += piece.error.input_area;
    for (const SurfaceSamples& each :
         decode_samples(section_of(stage, piece.divided_file, piece.divided.samples),
                        piece.divided_file.name)) {
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

/// Adds an error, weighted by the area it represents.
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
  FoundDistances found = found_distances(stage, result, threads);
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
