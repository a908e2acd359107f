// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// Bounds on the greatest distance of any point of one surface to another, in the mesh's unit. Both
/// bounds allow for rounding, by 2^-44 of the greatest coordinate and of themselves.
struct DistanceBounds {
  double lower = 0;
  double upper = 0;
};

struct HausdorffOptions {
  /// Distances up to this are not distinguished: `upper` may be as large although everything is
  /// nearer.
  double enough = 0;
  /// If the distance exceeds `enough`, the bounds end up at most `gap` apart, or at most this share
  /// of `lower`, unless a triangle would have to be cut into more than `most_pieces`.
  double gap = 0;
  double relative_gap = 0;
  std::uint64_t most_pieces = std::uint64_t{1} << 16;
  /// Stop once it is clear that `upper` cannot be `enough`: the bounds may then be far apart.
  bool stops_beyond = false;
  unsigned threads = 0;  // 0: one per core. The result does not depend on it.
};

/// Bounds the distance of the farthest point of the triangles to the surface of `to`, over all
/// points, not only samples: branch and bound of pieces of triangles against triangles (Tang et al.
/// 2009). A triangle without area counts as the segment or point that it is. Coordinates must be
/// finite. About 4 bytes per vertex. Zeros if there are no triangles.
DistanceBounds bound_distance(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                              const TriangleIndex& to, const HausdorffOptions& options);

/// The same for surfaces that may be empty: the distance from something to nothing is infinite.
DistanceBounds bound_distance(const Mesh& from, const Mesh& to, const HausdorffOptions& options);

/// The triangles not proven to lie entirely within the distance, ascending: all that have a point
/// beyond it, and maybe some that come within a thousandth of it.
std::vector<std::uint32_t> find_beyond(std::span<const Vec3> positions,
                                       std::span<const Triangle> triangles, const TriangleIndex& to,
                                       double distance, unsigned threads);

/// Whether there are no such triangles. Faster where there are some.
bool is_within(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads);

/// Removes triangles with coincident corners: they are not part of the surface, and a run drops
/// them.
void drop_coincident_corners(Mesh& mesh);

}  // namespace meshfarm
