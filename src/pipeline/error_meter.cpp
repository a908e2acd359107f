// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/error_meter.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/geometry/weighted_values.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

/// Most points of a result are nearer than this multiple of the RMS.
constexpr double k_usual = 2.5;
/// The first pass need not look farther than this: so many triangles would be near each point that
/// the second pass is cheaper.
constexpr double k_far_in_spacings = 2;
/// This many of the farthest points show where to look more closely, at points this fraction of the
/// greatest distance apart.
constexpr std::size_t k_looked_round = 100;
constexpr double k_closer_step = 0.1;
/// Enough for an estimate that is off by a few per cent.
constexpr std::uint64_t k_points_for_estimate = 5'000;

/// Every `step`-th of the points.
std::vector<Vec3> thinned(std::span<const Vec3> points, std::uint64_t step) {
  std::vector<Vec3> thinned;
  thinned.reserve(points.size() / step + 1);
  for (std::uint64_t i = 0; i < points.size(); i += step) thinned.push_back(points[i]);
  return thinned;
}

std::uint64_t step_for(std::uint64_t count, std::uint64_t most) {
  return std::max<std::uint64_t>(1, (count + most - 1) / most);
}

/// The area of those sets that have points.
double area_sampled(std::span<const SurfaceSamples> samples) {
  double area = 0;
  for (const SurfaceSamples& part : samples) area += part.points.empty() ? 0 : part.area;
  return area;
}

/// The greatest value that several threads find.
class Greatest {
 public:
  explicit Greatest(double least) : value_(least) {}
  void add(double value) {
    const std::lock_guard lock(mutex_);
    value_ = std::max(value_, value);
  }
  double value() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  double value_;
};

}  // namespace

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

ErrorMeter::ErrorMeter(const Stage& stage, const Manifest& manifest,
                       std::vector<SurfaceSamples> samples, unsigned threads,
                       const ErrorPoints& points)
    : manifest_(manifest),
      threads_(threads),
      points_(points),
      samples_(std::move(samples)),
      area_(area_sampled(samples_)),
      input_(stage, manifest, threads),
      normals_(manifest, area_) {
  for (const SurfaceSamples& part : samples_) {
    surface_.insert(surface_.end(), part.points.begin(), part.points.end());
  }
  const auto triangles = static_cast<double>(std::max<std::uint64_t>(1, manifest.triangles()));
  spacing_ = std::sqrt(2 * area_ / triangles);
}

ErrorMeter::ResultPoints ErrorMeter::points_of(const Mesh& result) const {
  SurfaceSamples samples =
      sample_surface(result, {.samples = points_.by_area, .threads = threads_});
  ResultPoints all{std::move(samples.points), 0, samples.area};
  all.by_area = all.points.size();
  const std::vector<Vec3> vertices =
      thinned(result.positions, step_for(result.positions.size(), points_.vertices));
  all.points.insert(all.points.end(), vertices.begin(), vertices.end());
  for (const std::uint32_t v : farthest_points(heights_of_vertices(result), points_.peaks)) {
    all.points.push_back(result.positions[v]);
  }
  const std::vector<Vec3> middles =
      thinned(middles_of_longest_sides(result.positions, result.triangles),
              step_for(result.triangles.size(), points_.sides));
  all.points.insert(all.points.end(), middles.begin(), middles.end());
  return all;
}

/// Each set of samples is weighted by its area.
std::vector<double> ErrorMeter::measure_samples(const DistanceMeter& meter,
                                                MeasuredError& measured) const {
  std::vector<DistanceMeter::Points> points;
  for (const SurfaceSamples& part : samples_) points.emplace_back(part.points);
  std::vector<double> of_points(surface_.size());
  const std::vector<Distance> distances = meter.measure_each(points, of_points);
  Distance error;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Distance& d = distances[i];
    error.rms += samples_[i].area * d.rms * d.rms;
    error.mean += samples_[i].area * d.mean;
    error.max = std::max(error.max, d.max);
  }
  measured.to_output = {std::sqrt(error.rms / area_), error.mean / area_, error.max};
  std::vector<std::pair<double, double>> weighted;
  weighted.reserve(of_points.size());
  for (const SurfaceSamples& part : samples_) {
    const double each = part.area / static_cast<double>(part.points.size());
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      weighted.emplace_back(of_points[weighted.size()], each);
    }
  }
  WeightedValues values(std::move(weighted));
  measured.to_output_quantiles = DistanceQuantiles{values.quantile(0.95), values.quantile(0.99)};
  return of_points;
}

double ErrorMeter::estimate_rms(const DistanceMeter& to_result) const {
  if (!(area_ > 0)) return 0;
  const std::uint64_t step = step_for(surface_.size(), k_points_for_estimate);
  double sum = 0;
  for (const SurfaceSamples& part : samples_) {
    const double rms = to_result.measure(thinned(part.points, step)).rms;
    sum += part.area * rms * rms;
  }
  return std::sqrt(sum / area_);
}

/// Shows the input to the points of the result, from several threads; also shows each piece of it
/// once to `once`.
void ErrorMeter::show_input(PointMeter& to_input,
                            const std::function<void(const SurfacePiece&)>& once) {
  for (bool is_first = true; to_input.begin_pass(); is_first = false) {
    input_.show([&](const Box& box) { return to_input.wants(box); },
                [&](const SurfacePiece& piece) {
                  to_input.show(piece.positions, piece.triangles);
                  if (is_first) once(piece);
                });
  }
}

/// Points of a piece of the input that may be farther from the result than the greatest distance
/// known.
std::vector<Vec3> ErrorMeter::points_of(const SurfacePiece& piece,
                                        const PlacesOfPoints& farthest_samples,
                                        double known) const {
  std::vector<Vec3> points =
      thinned(piece.fresh, step_for(manifest_.input_vertices, points_.input_vertices));
  if (manifest_.input_vertices <= points_.input_sides) {
    const std::vector<Vec3> middles = middles_of_longest_sides(piece.positions, piece.triangles);
    points.insert(points.end(), middles.begin(), middles.end());
  }
  const double radius = std::sqrt(area_ / static_cast<double>(surface_.size()));
  farthest_samples.append_points_of(piece.positions, piece.triangles,
                                    {k_closer_step * known, radius}, points);
  return points;
}

/// The greatest distance on those triangles of the result that have the farthest points.
double ErrorMeter::farthest_round(std::span<const Vec3> points, std::span<const double> distances,
                                  double radius, const DistanceMeter& to_result) {
  std::vector<Vec3> farthest;
  for (const std::uint32_t i : farthest_points(distances, k_looked_round)) {
    farthest.push_back(points[i]);
  }
  const std::vector<std::uint32_t> triangles = to_result.nearest_triangles(farthest);
  std::map<std::uint32_t, std::vector<Vec3>> places;  // by the triangle they lie on
  for (std::size_t i = 0; i < farthest.size(); ++i) places[triangles[i]].push_back(farthest[i]);
  const double known = distance_of(distances).max;
  const Mesh& result = to_result.index().mesh();
  std::vector<Vec3> closer;
  for (const auto& [triangle, here] : places) {
    append_points(result.positions, result.triangles[triangle], here,
                  {k_closer_step * known, radius}, closer);
  }
  PointMeter to_input(closer, {.spacing = spacing_, .surface = surface_, .all_are_beyond = true});
  show_input(to_input, [](const SurfacePiece&) {});
  return std::max(known, distance_of(to_input.distances()).max);
}

void ErrorMeter::measure_normals(const TriangleIndex& result, MeasuredError& measured) const {
  const std::vector<NearPlace> places = find_near_places(result, facing_->points, threads_);
  measured.to_output_normals = normals_of(places, facing_->areas);
  measured.normal_samples = places.size();
}

MeasuredError ErrorMeter::measure(const Mesh& result,
                                  const std::function<void(const TriangleIndex&)>& with_index) {
  MeasuredError error;
  if (result.triangles.empty() || !(area_ > 0)) return error;
  const DistanceMeter to_result(result, threads_);
  const std::vector<double> of_samples = measure_samples(to_result, error);
  const ResultPoints from = points_of(result);
  // The maximum if that is within the distance of neighbours: the first pass then finds them all.
  const double usual =
      std::max(std::min(k_usual * error.to_output.rms, k_far_in_spacings * spacing_),
               std::min(2 * error.to_output.max, spacing_));
  PointMeter to_input(from.points, {spacing_, usual, surface_});
  const double least = error.to_output.max;
  const PlacesOfPoints farthest_samples(surface_, farthest_points(of_samples, k_looked_round));
  Greatest greatest(least);
  show_input(to_input, [&](const SurfacePiece& piece) {
    if (!facing_) normals_.add(piece);
    greatest.add(to_result.farthest(points_of(piece, farthest_samples, least), least));
  });
  error.to_output.max = greatest.value();
  if (!facing_) facing_ = normals_.take();
  measure_normals(to_result.index(), error);
  const std::vector<double> distances = to_input.distances();
  error.to_input = distance_of(std::span(distances).first(from.by_area));
  error.to_input.max = farthest_round(from.points, distances, from.spacing(), to_result);
  std::vector<double> by_area(distances.begin(),
                              distances.begin() + static_cast<std::ptrdiff_t>(from.by_area));
  error.to_input_quantiles = quantiles_of(by_area);
  error.input_samples = surface_.size();
  error.output_samples = from.by_area;
  if (with_index) with_index(to_result.index());
  return error;
}

}  // namespace meshfarm
