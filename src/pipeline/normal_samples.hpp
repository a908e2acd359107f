// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/piece_samples.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

namespace meshfarm {

/// Points of an input that comes in pieces, with its normals there: one per 200 triangles, from
/// 2,000 to 20,000, distributed by area.
class NormalSamples {
 public:
  /// `area`: of the input.
  NormalSamples(const Manifest& manifest, double area);
  /// Called from several threads; the pieces of a part in order.
  void add(const SurfacePiece& piece);

  struct Points {
    std::vector<FacingPoint> points;
    std::vector<double> areas;  // that they represent
  };
  /// In an order that does not depend on the threads. Call this last.
  Points take();

 private:
  struct OfPart {
    Points sampled;
    double due = 0;  // fraction of a point still to be taken from later pieces
  };

  double per_area_;  // points
  std::vector<OfPart> parts_;
};

}  // namespace meshfarm
