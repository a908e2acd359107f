// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/report/summary.hpp>

#include "pipeline/input_surface.hpp"

namespace meshfarm {

/// Measures how far a result is from the input, in both directions.
///
/// RMS and mean come from points that are shared out by area. Of the input the workers took them,
/// while they had it in memory; those of the result are measured against the input as it lies in
/// the stage, read once more. The maximum counts vertices, too, as extremes of surfaces lie there.
class ErrorMeter {
 public:
  /// `samples`: of the input, each set standing for its area. Stage and manifest must outlive this.
  ErrorMeter(const Stage& stage, const Manifest& manifest, std::vector<SurfaceSamples> samples,
             unsigned threads);

  MeasuredError measure(const Mesh& result);
  /// The greatest distance of the samples alone.
  double farthest_sample(const Mesh& result) const;

 private:
  Distance measure_samples(const DistanceMeter& meter) const;

  const Manifest& manifest_;
  unsigned threads_;
  std::vector<SurfaceSamples> samples_;
  double area_ = 0;  // of the input
  std::vector<Vec3> all_points_;
  InputSurface input_;
};

}  // namespace meshfarm
