// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/closer_look.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/report/summary.hpp>

#include "pipeline/normal_samples.hpp"

namespace meshfarm {

/// RMS, mean and maximum.
Distance distance_of(std::span<const double> distances);

/// How many points are checked for the maximum: those that the sum of squares needs, and more.
struct ErrorPoints {
  std::uint64_t by_area = 20'000;            // of the result
  std::uint64_t vertices = 10'000;           // of the result, at most
  std::uint64_t peaks = 10'000;              // result vertices farthest from their neighbours
  std::uint64_t sides = 10'000;              // of the result: midpoints of longest sides, at most
  std::uint64_t input_vertices = 1'000'000;  // at most
  std::uint64_t input_sides = 30'000;        // midpoints count up to this many vertices
};

/// For a bound on the error, which is a bound on the maximum.
inline constexpr ErrorPoints k_points_for_bound{200'000, 400'000,   400'000,
                                                400'000, 4'000'000, 2'000'000};

/// Measures how far a result is from the input, in both directions.
///
/// RMS and mean are computed from points distributed by area. The workers sampled the input while
/// they had it in memory; points of the result are measured against the input in the stage, which
/// is read again. The maximum also includes vertices, as extremes of surfaces lie there. No figure
/// depends on the number of threads.
class ErrorMeter {
 public:
  /// `samples`: of the input; each set represents its area. Stage and manifest must outlive this.
  ErrorMeter(const Stage& stage, const Manifest& manifest, std::vector<SurfaceSamples> samples,
             unsigned threads, const ErrorPoints& points = {});

  /// `with_index` may measure more with the result's index.
  MeasuredError measure(const Mesh& result,
                        const std::function<void(const TriangleIndex&)>& with_index = {});
  /// Estimates the RMS from the input to the result from few points: much cheaper.
  double estimate_rms(const DistanceMeter& to_result) const;

 private:
  struct ResultPoints {
    std::vector<Vec3> points;
    std::size_t by_area = 0;  // the first of them
    double area = 0;

    double spacing() const { return std::sqrt(area / static_cast<double>(by_area)); }
  };

  ResultPoints points_of(const Mesh& result) const;
  std::vector<Vec3> points_of(const SurfacePiece& piece, const PlacesOfPoints& farthest_samples,
                              double known) const;
  /// From the input to the result. Returns the distances of all samples.
  std::vector<double> measure_samples(const DistanceMeter& meter, MeasuredError& measured) const;
  void show_input(PointMeter& to_input, const std::function<void(const SurfacePiece&)>& once);
  double farthest_round(std::span<const Vec3> points, std::span<const double> distances,
                        double radius, const DistanceMeter& to_result);
  void measure_normals(const TriangleIndex& result, MeasuredError& measured) const;

  const Manifest& manifest_;
  unsigned threads_;
  ErrorPoints points_;
  std::vector<SurfaceSamples> samples_;
  double area_;                // of the input
  double spacing_ = 0;         // of its vertices, approximately
  std::vector<Vec3> surface_;  // all samples
  InputSurface input_;
  NormalSamples normals_;
  std::optional<NormalSamples::Points> facing_;  // set once all of the input was shown
};

}  // namespace meshfarm
