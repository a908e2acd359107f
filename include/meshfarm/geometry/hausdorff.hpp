// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// The greatest distance of any point of one surface to another lies between these, in the mesh's
/// unit. Both allow for rounding, by 2^-44 of the greatest coordinate and of themselves.
struct DistanceBounds {
  double lower = 0;
  double upper = 0;
};

struct HausdorffOptions {
  /// What is no farther is not told apart: `upper` may be as much though all is nearer.
  double enough = 0;
  /// Where the distance is more than enough, the bounds end up no farther apart than `gap`, or than
  /// this share of `lower`, unless a triangle would have to be cut into more than `most_pieces`.
  double gap = 0;
  double relative_gap = 0;
  std::uint64_t most_pieces = std::uint64_t{1} << 16;
  /// Stop where it is clear that `upper` cannot be `enough`: the bounds may be far apart then.
  bool stops_beyond = false;
  unsigned threads = 0;  // 0: one a core. The result does not depend on it.
};

/// Bounds the distance of the farthest point of the triangles to the surface of `to`, over all
/// points and not only samples: branch and bound of pieces of triangles against triangles (Tang et
/// al. 2009). A triangle without area is the segment or point that it is. Coordinates must be
/// finite. About 4 bytes a vertex. Zeros for no triangles.
DistanceBounds bound_distance(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                              const TriangleIndex& to, const HausdorffOptions& options);

/// The same for surfaces that may be empty: from something to nothing it is infinite.
DistanceBounds bound_distance(const Mesh& from, const Mesh& to, const HausdorffOptions& options);

/// Which of the triangles are not proven to be within the distance as a whole, ascending: all that
/// have a point beyond it, and maybe some that come within a thousandth of it.
std::vector<std::uint32_t> find_beyond(std::span<const Vec3> positions,
                                       std::span<const Triangle> triangles, const TriangleIndex& to,
                                       double distance, unsigned threads);

/// Whether there are none of these: sooner known where there are some.
bool is_within(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads);

/// Leaves out triangles with two corners at one place: they are no surface, and a run drops them.
void drop_coincident_corners(Mesh& mesh);

}  // namespace meshfarm
