// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

struct VertexFitOptions {
  /// Positions are rounded to this before they are checked.
  PositionType positions = PositionType::float64;
  /// This many vertices at the start stay. The surface continues beyond them, so points nearest to
  /// a side of a triangle with one of them are ignored.
  std::uint32_t locked_vertices = 0;
  /// The ends of open borders stay.
  bool keeps_borders = false;
  /// If above 0: the ends of edges sharper than this many degrees stay.
  double crease_angle = 0;
  unsigned threads = 0;  // 0: one per core. The result does not depend on it.
};

/// Moves the vertices of `mesh` so that it comes nearer to `points` of the surface that it
/// represents, in the least squares of the distances; the triangles stay (Hoppe et al. 1993, with
/// one search for the nearest places). Every set of points is weighted by its area. Each vertex is
/// also held to its place, with the weight of two points: where points are few, it hardly moves.
/// Coincident vertices stay, and so do vertices where lines between labels meet or end. No triangle
/// turns by more than about 30 degrees or loses more than 70 % of its area. Returns how many
/// vertices moved. Coordinates must be finite. Memory: about 130 bytes per vertex, 40 per triangle
/// and 32 to 64 per point.
std::uint64_t fit_vertices(Mesh& mesh, std::span<const SurfaceSamples> points,
                           const VertexFitOptions& options);

}  // namespace meshfarm
