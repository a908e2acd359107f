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

/// The position of a sample of the input, and its distance from the result.
struct MeasuredPlace {
  FacingPoint point;
  NearPlace near;
  double area = 0;  // represented by the sample
};

/// Samples of an input that arrives in pieces, and its shape figures. Memory use does not depend on
/// the input's size.
class InputSamples {
 public:
  explicit InputSamples(const Manifest& manifest);
  /// Safe from several threads; the pieces of each part must come in order.
  void add(const SurfacePiece& piece);
  /// If there are many triangles, angles are those of a subset.
  ShapeMeasures shape() const;
  /// All samples, by part. Call last.
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
  std::uint64_t step_;  // between triangles whose angles are measured
  Vec3 origin_;
  std::vector<OfPart> parts_;  // and one for what is between parts
  std::mutex mutex_;
  ShapeMeter angles_{1};
};

struct ErrorFigures {
  SurfaceError error;        // as in compare, each sample weighted by its area
  ErrorHistogram histogram;  // up to the distance that 95 % of the area are within
};
ErrorFigures error_figures_of(std::span<const MeasuredPlace> places);
/// Per vertex, the mean distance of the samples nearest to its triangles; without any, the
/// neighbours' mean.
std::vector<float> errors_at_vertices(const Mesh& result, std::span<const MeasuredPlace> places);

}  // namespace meshfarm
