// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// The triangles whose centres have one that faces against them within `reach`: only these can face
/// the wrong way by the nearest point of a surface that this mesh is near to. Depends on no threads
/// (0: one a core).
std::vector<std::uint32_t> find_opposed_triangles(const TriangleIndex& index, double reach,
                                                  unsigned threads);

struct FacingMended {
  std::uint64_t found = 0;  // triangles that faced the wrong way
  std::uint64_t mended = 0;
};

struct FacingRepairOptions {
  /// No vertex is moved farther. What is moved comes to lie within half of it from the original, or
  /// no farther than it was.
  double reach = 0;
  PositionType positions = PositionType::float64;
};

/// Mends triangles that face the wrong way: away from the nearest point of the original to their
/// centre. Flips one of their edges, or moves one, two or all three of their vertices, or all of a
/// small piece, so that fewer triangles do, none is turned by more than 60 degrees that did not,
/// and no more pairs cross than before. The number of triangles and what hangs together stay;
/// vertices of borders do not move.
/// The mesh must outlive it and have finite coordinates. Memory: about 70 bytes a triangle, once
/// one of them is to be mended.
class FacingRepair {
 public:
  FacingRepair(Mesh& mesh, const FacingRepairOptions& options);
  ~FacingRepair();

  /// Of these triangles. `original`: what of it is within reach of all triangles at their vertices,
  /// with finite coordinates; another one at each call.
  FacingMended mend(std::span<const std::uint32_t> triangles, const Mesh& original);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
