// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/stream_file.hpp>

namespace meshfarm {

struct SweepOptions {
  /// Collapse no edge that costs more (SimplifyGoal::max_cost): one threshold, no quota per window.
  double max_cost = std::numeric_limits<double>::infinity();
  /// Where above 0: the share of the triangles that is kept, the same for each window (Xiong et al.
  /// 2008).
  double ratio = 0;
  LineOptions lines;
  /// The size of the buffer, in triangles. Exceeded only if the front alone is larger.
  std::uint64_t window_triangles = 0;
  /// Number of points to sample from the stream's surface, to measure an error by.
  std::uint64_t samples = 0;
  /// Whether to measure the error: the greatest distance from those points to the result.
  bool measure = false;
  /// Told the number of triangles read so far; stops the work by returning false.
  std::function<bool(std::uint64_t triangles)> progress;
};

/// Takes the output of a sweep: the next vertices of the result, numbered after its boundary
/// vertices, and triangles with their columns, of any vertices so far and of boundary vertices.
using SweepOutput =
    std::function<void(const VertexView& vertices, std::span<const Triangle> triangles,
                       const TriangleColumnsView& columns)>;

/// Facts about a simplified stream at its end.
struct SweptStream {
  Mesh boundary;                     // the result's first vertices, unmoved, in stream order
  std::uint64_t free_triangles = 0;  // those without a boundary vertex
  SurfaceSamples samples;
  double error = 0;  // if it was to be measured
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t dropped_duplicate = 0;
  std::uint64_t turned = 0;
};

/// Simplifies a stream in one pass through a bounded buffer (Wu & Kobbelt 2003; Xiong et al. 2008,
/// 4.2): reads a window, collapses every edge that is cheap enough and whose ends are finalised and
/// not boundary vertices, sends on what lies some rings behind the front, and reads on. Quadrics
/// are computed from the buffer's current mesh, so nothing is carried along; only the boundary
/// vertices and the samples are kept to the end. Throws DataError; IncompleteError if stopped.
SweptStream sweep(StreamReader& reader, const SweepOptions& options, const SweepOutput& output);

}  // namespace meshfarm
