// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include <meshfarm/geometry/piece_samples.hpp>
#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/geometry/triangle_index.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/report/run_page.hpp>

namespace meshfarm {

/// Where a sample of the input is, and how far from the result.
struct MeasuredPlace {
  FacingPoint point;
  NearPlace near;
  double area = 0;  // that it stands for
};

/// Points of an input that comes in pieces, and figures of its shape. What it takes does not depend
/// on the input's size.
class InputSamples {
 public:
  explicit InputSamples(const Manifest& manifest);
  /// From several threads; the pieces of a part in order.
  void add(const SurfacePiece& piece);
  /// Of angles those of some of the triangles, where there are many.
  ShapeMeasures shape() const;
  /// All points, by parts. Call this last.
  std::vector<MeasuredPlace> measure(const TriangleIndex& result, unsigned threads);

 private:
  struct Some {
    std::vector<FacingPoint> points;
    double area_of_each = 0;
  };
  struct OfPart {
    std::vector<Some> pieces;
    double area = 0;
    double volume = 0;
  };

  double triangles_;    // of the input
  std::uint64_t step_;  // of the triangles whose angles are measured
  Vec3 origin_;
  std::vector<OfPart> parts_;  // and what is between them
  std::mutex mutex_;
  ShapeMeter angles_{1};
};

struct ErrorFigures {
  SurfaceError error;        // as compare has it, each place by its area
  ErrorHistogram histogram;  // up to what 95 % of the area are within
};
ErrorFigures error_figures_of(std::span<const MeasuredPlace> places);
/// Of each vertex the mean distance of the places that are nearest to its triangles; where there
/// are none, that of its neighbours.
std::vector<float> errors_at_vertices(const Mesh& result, std::span<const MeasuredPlace> places);

}  // namespace meshfarm
