// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Samples a surface by area. The surface comes piece by piece, so its area is known only at the
/// end. Whenever there are too many samples, every second one is removed, and each sample stands
/// for twice the area from then on.
class SurfaceSampler {
 public:
  struct Sample {
    Vec3 point;
    double distance = HUGE_VAL;  // for the user
  };

  /// Takes two to four thirds of `samples`; none from a surface without area.
  explicit SurfaceSampler(std::uint64_t samples) : least_((2 * samples + 2) / 3) {}
  void add(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  std::span<Sample> samples() { return samples_; }
  /// The points. Call this last.
  SurfaceSamples take();

 private:
  void add_point(Vec3 a, Vec3 b, Vec3 c);
  void thin();
  double next_place() const;

  std::uint64_t least_;
  double area_ = 0;            // so far
  double share_ = 0;           // the area that a sample stands for
  std::uint64_t thinned_ = 0;  // times
  std::vector<Sample> samples_;
};

}  // namespace meshfarm
