// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/report_samples.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <meshfarm/geometry/weighted_values.hpp>

namespace meshfarm {
namespace {

constexpr double k_samples = 100'000;
constexpr double k_angles = 200'000;

WeightedValues distances_of(std::span<const MeasuredPlace> places) {
  std::vector<std::pair<double, double>> distances;
  distances.reserve(places.size());
  for (const MeasuredPlace& p : places) distances.emplace_back(p.near.distance, p.area);
  return WeightedValues(std::move(distances));
}

NormalDeviation deviation_of(std::span<const MeasuredPlace> places) {
  std::vector<NearPlace> near;
  std::vector<double> areas;
  for (const MeasuredPlace& p : places) {
    near.push_back(p.near);
    areas.push_back(p.area);
  }
  return normals_of(near, areas);
}

SurfaceError error_of(std::span<const MeasuredPlace> places, WeightedValues& distances) {
  SurfaceError error;
  double area = 0;
  for (const MeasuredPlace& p : places) {
    const double d = p.near.distance;
    area += p.area;
    error.distance.rms += p.area * d * d;
    error.distance.mean += p.area * d;
    error.distance.max = std::max(error.distance.max, d);
  }
  if (!(area > 0)) return error;
  error.distance.rms = std::sqrt(error.distance.rms / area);
  error.distance.mean /= area;
  error.quantiles = {distances.quantile(0.95), distances.quantile(0.99)};
  error.normals = deviation_of(places);
  return error;
}

ErrorHistogram histogram_of(WeightedValues& distances) {
  constexpr std::size_t k_bins = 40;
  ErrorHistogram made;
  made.end = distances.quantile(0.95);
  made.shares.resize(k_bins, 0);
  const double area = distances.weight();
  for (const auto& [distance, of_point] : distances.values()) {
    const double bin = made.end > 0 ? distance / made.end * k_bins : 0;
    if (bin >= k_bins && distance > made.end) {
      made.beyond += of_point;
    } else {
      made.shares[std::min(static_cast<std::size_t>(bin), k_bins - 1)] += of_point;
    }
  }
  if (!(area > 0)) return made;
  made.beyond /= area;
  for (double& share : made.shares) share /= area;
  return made;
}

}  // namespace

InputSamples::InputSamples(const Manifest& manifest)
    : triangles_(static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles()))),
      step_(static_cast<std::uint64_t>(std::ceil(triangles_ / k_angles))),
      origin_((manifest.box.lo + manifest.box.hi) * 0.5),
      parts_(manifest.parts.size() + 1) {}

void InputSamples::add(const SurfacePiece& piece) {
  const double share = static_cast<double>(piece.triangles.size()) / triangles_;
  const auto count = static_cast<std::uint64_t>(std::max(1.0, std::round(share * k_samples)));
  PieceSamples samples = sample_piece(piece.positions, piece.triangles, count, origin_);
  OfPart& part = parts_[piece.part];
  part.area += samples.area;
  part.volume += samples.volume;
  if (!samples.points.empty()) {
    const double each = samples.area / static_cast<double>(samples.points.size());
    part.pieces.push_back({std::move(samples.points), each});
  }
  std::vector<Triangle> some;
  some.reserve(piece.triangles.size() / step_ + 1);
  for (std::size_t i = 0; i < piece.triangles.size(); i += step_) {
    some.push_back(piece.triangles[i]);
  }
  const std::lock_guard lock(mutex_);
  angles_.add(piece.positions, some);
}

ShapeMeasures InputSamples::shape() const {
  ShapeMeasures shape = angles_.measures();
  shape.area = shape.volume = 0;
  for (const OfPart& part : parts_) {
    shape.area += part.area;
    shape.volume += part.volume;
  }
  return shape;
}

std::vector<MeasuredPlace> InputSamples::measure(const TriangleIndex& result, unsigned threads) {
  std::vector<FacingPoint> points;
  std::vector<MeasuredPlace> places;
  for (OfPart& part : parts_) {
    for (const Some& some : part.pieces) {
      for (const FacingPoint& p : some.points) {
        points.push_back(p);
        places.push_back({p, {}, some.area_of_each});
      }
    }
    part.pieces = {};
  }
  const std::vector<NearPlace> found = find_near_places(result, points, threads);
  for (std::size_t i = 0; i < found.size(); ++i) places[i].near = found[i];
  return places;
}

ErrorFigures error_figures_of(std::span<const MeasuredPlace> places) {
  WeightedValues distances = distances_of(places);
  return {error_of(places, distances), histogram_of(distances)};
}

std::vector<float> errors_at_vertices(const Mesh& result, std::span<const MeasuredPlace> places) {
  constexpr int k_rounds = 4;
  std::vector<double> sums(result.positions.size(), 0);
  std::vector<double> areas(result.positions.size(), 0);
  for (const MeasuredPlace& p : places) {
    for (const std::uint32_t vertex : result.triangles[p.near.triangle]) {
      sums[vertex] += p.area * p.near.distance;
      areas[vertex] += p.area;
    }
  }
  std::vector<float> errors(sums.size(), -1);
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (areas[v] > 0) errors[v] = static_cast<float>(sums[v] / areas[v]);
  }
  for (int round = 0; round < k_rounds; ++round) {
    std::fill(sums.begin(), sums.end(), 0);
    std::fill(areas.begin(), areas.end(), 0);
    for (const Triangle& t : result.triangles) {
      for (const std::uint32_t from : t) {
        if (errors[from] < 0) continue;
        for (const std::uint32_t to : t) {
          sums[to] += static_cast<double>(errors[from]);
          areas[to] += 1;
        }
      }
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
      if (errors[v] < 0 && areas[v] > 0) errors[v] = static_cast<float>(sums[v] / areas[v]);
    }
    if (std::none_of(errors.begin(), errors.end(), [](float e) { return e < 0; })) break;
  }
  for (float& error : errors) error = std::max(error, 0.0F);
  return errors;
}

}  // namespace meshfarm
