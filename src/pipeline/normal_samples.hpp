// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/piece_samples.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

namespace meshfarm {

/// Points of an input that comes in pieces, and which way it faces there: one for 200 triangles,
/// from 2,000 to 20,000, spread by area.
class NormalSamples {
 public:
  /// `area`: of the input.
  NormalSamples(const Manifest& manifest, double area);
  /// From several threads; the pieces of a part in order.
  void add(const SurfacePiece& piece);

  struct Points {
    std::vector<FacingPoint> points;
    std::vector<double> areas;  // that they stand for
  };
  /// In an order that does not depend on the threads. Call this last.
  Points take();

 private:
  struct OfPart {
    Points sampled;
    double due = 0;  // points, not a whole one, that the pieces so far had too few of
  };

  double per_area_;  // points
  std::vector<OfPart> parts_;
};

}  // namespace meshfarm
