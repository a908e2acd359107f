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
  /// The first so many vertices stay. The surface goes on beyond them, so points that are nearest
  /// to a side of a triangle with one of them tell nothing.
  std::uint32_t locked_vertices = 0;
  /// The ends of open borders stay.
  bool keeps_borders = false;
  /// Above 0: the ends of edges that are sharper than so many degrees stay.
  double crease_angle = 0;
  unsigned threads = 0;  // 0: one a core. The result does not depend on it.
};

/// Moves the vertices of `mesh` so that it is nearer to `points` of the surface that it stands for,
/// in the least squares of the distances; triangles stay as they are (Hoppe et al. 1993, with one
/// search for the nearest places). Every set of points counts by its area. A vertex also holds on
/// to its place, as two points would: where few points are, it hardly moves. Vertices at the same
/// place stay, and where lines between labels meet or end, and no triangle turns by more than about
/// 30 degrees or loses more than 70 % of its area. Returns how many vertices moved. Coordinates
/// must be finite. Memory: about 130 bytes a vertex, 40 a triangle and 32 to 64 a point.
std::uint64_t fit_vertices(Mesh& mesh, std::span<const SurfaceSamples> points,
                           const VertexFitOptions& options);

}  // namespace meshfarm
