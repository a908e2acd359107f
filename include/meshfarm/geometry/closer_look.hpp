// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/near_cells.hpp>

namespace meshfarm {

// Points that are shared out by area seldom hit where a surface is farthest from another one. The
// farthest of them tell where it is worth to look at more points.

/// The farthest points, by index, farthest first: at most so many.
std::vector<std::uint32_t> farthest_points(std::span<const double> distances, std::size_t most);

/// How far each vertex is from the middle of its neighbours. Spikes are high.
std::vector<double> heights_of_vertices(const Mesh& mesh);

/// How close the points are that are looked at.
struct CloserSteps {
  double step = 0;    // of a grid over a triangle, which has at most 66 points
  double radius = 0;  // round a point on a larger triangle: 49 points, in steps of a third of it
};

/// Appends points of a triangle that the places are on: a grid over all of it, its corners among
/// them, and where that is coarse some round each place.
void append_points(std::span<const Vec3> positions, const Triangle& triangle,
                   std::span<const Vec3> places, const CloserSteps& steps,
                   std::vector<Vec3>& points);

/// Points that are looked for in a surface that they were taken from.
class PlacesOfPoints {
 public:
  PlacesOfPoints(std::span<const Vec3> points, std::span<const std::uint32_t> some);
  /// Appends points of those triangles that the places lie on, and of some beside them: whose boxes
  /// they are in.
  void append_points_of(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                        const CloserSteps& steps, std::vector<Vec3>& points) const;

 private:
  std::vector<Vec3> places_;
  NearCells cells_;
};

}  // namespace meshfarm
