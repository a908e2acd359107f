// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/near_cells.hpp>

namespace meshfarm {

// Points sampled by area seldom hit the place where a surface is farthest from another one. The
// farthest of them show where more points are worth sampling.

/// The indices of the farthest points, farthest first: at most `most`.
std::vector<std::uint32_t> farthest_points(std::span<const double> distances, std::size_t most);

/// How far each vertex is from the middle of its neighbours. Spikes are high.
std::vector<double> heights_of_vertices(const Mesh& mesh);

/// Spacing of the additional points.
struct CloserSteps {
  double step = 0;    // of a grid over a triangle, which has at most 66 points
  double radius = 0;  // round a place on a larger triangle: 49 points, spaced a third of it
};

/// Appends points of a triangle that contains the places: a grid over the whole triangle, including
/// its corners, and, where that is coarse, some round each place.
void append_points(std::span<const Vec3> positions, const Triangle& triangle,
                   std::span<const Vec3> places, const CloserSteps& steps,
                   std::vector<Vec3>& points);

/// Points whose triangles are searched for in the surface that the points were taken from.
class PlacesOfPoints {
 public:
  PlacesOfPoints(std::span<const Vec3> points, std::span<const std::uint32_t> some);
  /// Appends points of the triangles that contain a place, and of some triangles beside them: all
  /// whose boxes contain it.
  void append_points_of(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                        const CloserSteps& steps, std::vector<Vec3>& points) const;

 private:
  std::vector<Vec3> places_;
  NearCells cells_;
};

}  // namespace meshfarm
