// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/error_meter.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include <meshfarm/geometry/point_meter.hpp>

namespace meshfarm {
namespace {

/// Points of the result: by area, which RMS and mean are made of, and vertices.
constexpr std::uint64_t k_area_points = 40'000;
constexpr std::uint64_t k_least_area_points = 20'000;
constexpr std::uint64_t k_triangles_a_point = 16;  // of the input: a small one is soon measured
constexpr std::uint64_t k_vertex_points = 40'000;
/// Vertices of the input that are looked at, at most, for one that is farther than the samples.
constexpr std::uint64_t k_input_vertices = 150'000;
/// Nearly all points of a result are nearer than so many times the RMS.
constexpr double k_usual = 4;

std::uint64_t area_points(const Manifest& manifest) {
  return std::clamp(manifest.triangles() / k_triangles_a_point, k_least_area_points, k_area_points);
}

/// Every n-th, so that there are at most so many.
template <class T>
std::vector<T> thinned(std::span<const T> values, std::uint64_t most) {
  std::vector<T> thinned;
  const std::uint64_t step = (values.size() + most - 1) / most;
  for (std::uint64_t i = 0; i < values.size(); i += step) thinned.push_back(values[i]);
  return thinned;
}

Distance distance_of(std::span<const double> distances) {
  Distance sums;
  for (const double d : distances) {
    sums.rms += d * d;
    sums.mean += d;
    sums.max = std::max(sums.max, d);
  }
  if (distances.empty()) return sums;
  const auto count = static_cast<double>(distances.size());
  return {std::sqrt(sums.rms / count), sums.mean / count, sums.max};
}

}  // namespace

ErrorMeter::ErrorMeter(const Stage& stage, const Manifest& manifest,
                       std::vector<SurfaceSamples> samples, unsigned threads)
    : manifest_(manifest),
      threads_(threads),
      samples_(std::move(samples)),
      input_(stage, manifest, threads) {
  for (const SurfaceSamples& part : samples_) {
    if (part.points.empty()) continue;
    area_ += part.area;
    all_points_.insert(all_points_.end(), part.points.begin(), part.points.end());
  }
}

/// Every set of samples counts by the area it stands for.
Distance ErrorMeter::measure_samples(const DistanceMeter& meter) const {
  std::vector<DistanceMeter::Points> points;
  for (const SurfaceSamples& part : samples_) points.emplace_back(part.points);
  const std::vector<Distance> distances = meter.measure_each(points);
  Distance error;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Distance& d = distances[i];
    error.rms += samples_[i].area * d.rms * d.rms;
    error.mean += samples_[i].area * d.mean;
    error.max = std::max(error.max, d.max);
  }
  return {std::sqrt(error.rms / area_), error.mean / area_, error.max};
}

double ErrorMeter::farthest_sample(const Mesh& result) const {
  if (result.triangles.empty() || !(area_ > 0)) return 0;
  return measure_samples(DistanceMeter(result, threads_)).max;
}

MeasuredError ErrorMeter::measure(const Mesh& result) {
  MeasuredError error;
  if (result.triangles.empty() || !(area_ > 0)) return error;
  const DistanceMeter to_result(result, threads_);
  error.to_output = measure_samples(to_result);
  error.input_samples = all_points_.size();

  SurfaceSamples by_area =
      sample_surface(result, {.samples = area_points(manifest_), .threads = threads_});
  std::vector<Vec3> points = std::move(by_area.points);
  const std::size_t counted = points.size();
  const std::vector<Vec3> vertices = thinned<Vec3>(result.positions, k_vertex_points);
  points.insert(points.end(), vertices.begin(), vertices.end());
  error.output_samples = counted;

  const double triangles = static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles()));
  const double spacing = std::sqrt(2 * area_ / triangles);
  // The maximum where that is within the neighbours' distance: the first pass then finds them all.
  const double usual =
      std::max(k_usual * error.to_output.rms, std::min(2 * error.to_output.max, spacing));
  PointMeter to_input(points, {spacing, usual, all_points_});
  const std::uint64_t step = (manifest_.input_vertices + k_input_vertices - 1) /
                             std::max<std::uint64_t>(1, k_input_vertices);
  const double least = error.to_output.max;
  std::mutex mutex;
  bool is_first = true;
  while (to_input.begin_pass()) {
    input_.show([&](const Box& box) { return to_input.wants(box); },
                [&](const SurfacePiece& piece) {
                  to_input.show(piece.positions, piece.triangles);
                  if (!is_first) return;
                  std::vector<Vec3> some;
                  for (std::size_t i = 0; i < piece.fresh.size(); i += step) {
                    some.push_back(piece.fresh[i]);
                  }
                  const double farthest = to_result.farthest(some, least);
                  const std::lock_guard lock(mutex);
                  error.to_output.max = std::max(error.to_output.max, farthest);
                });
    is_first = false;
  }
  const std::vector<double> distances = to_input.distances();
  error.to_input = distance_of(std::span(distances).first(counted));
  error.to_input.max = std::max(error.to_input.max, distance_of(distances).max);
  return error;
}

}  // namespace meshfarm
