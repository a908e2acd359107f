// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/stream_file.hpp>

namespace meshfarm {

struct SweepOptions {
  /// Collapse no edge that costs more (SimplifyGoal::max_cost): one threshold, no quota a window.
  double max_cost = std::numeric_limits<double>::infinity();
  /// Where above 0: this share of the triangles is kept, of each window the same (Xiong et al.
  /// 2008).
  double ratio = 0;
  LineOptions lines;
  /// The buffer: so many triangles are simplified together, but for a front that alone is more.
  std::uint64_t window_triangles = 0;
  /// Points of the stream's surface to take, by which an error can be measured.
  std::uint64_t samples = 0;
  /// Whether to measure the error: the greatest distance from those points to the result.
  bool measure = false;
  /// Told the triangles read so far; stops the work by returning false.
  std::function<bool(std::uint64_t triangles)> progress;
};

/// A simplified stream. Its boundary vertices come first, unmoved, in the stream's order.
struct SweptStream {
  Mesh mesh;
  std::uint32_t boundary_vertices = 0;
  std::uint64_t free_triangles = 0;  // those without a boundary vertex
  PositionType positions = PositionType::float32;
  SurfaceSamples samples;
  double error = 0;  // where it was to be measured
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
};

/// Simplifies a stream in one pass through a bounded buffer (Wu & Kobbelt 2003; Xiong et al. 2008,
/// 4.2): reads a window, collapses every edge that is cheap enough and whose ends are finalised and
/// no boundary vertices, sends on what lies some rings behind the front, reads on. Quadrics are
/// made from the buffer's current mesh, so that nothing is carried along. Throws DataError;
/// IncompleteError if stopped.
SweptStream sweep(StreamReader& reader, const SweepOptions& options);

}  // namespace meshfarm
