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

/// The triangles with an opposing triangle within `reach` of their centre. Only these can face the
/// wrong way relative to the nearest point of a surface that this mesh is near to. The result does
/// not depend on the threads (0: one per core).
std::vector<std::uint32_t> find_opposed_triangles(const TriangleIndex& index, double reach,
                                                  unsigned threads);

struct FacingMended {
  std::uint64_t found = 0;  // triangles that faced the wrong way
  std::uint64_t mended = 0;
};

struct FacingRepairOptions {
  /// No vertex is moved farther than this. What is moved ends up within half of it from the
  /// original, or no farther away than it was.
  double reach = 0;
  PositionType positions = PositionType::float64;
};

/// Repairs triangles that face the wrong way: away from the point of the original nearest to their
/// centre. Flips one of their edges, or moves one, two or all three of their vertices, or all of a
/// small piece. After each change fewer triangles face the wrong way, no triangle that faced the
/// right way is turned by more than 60 degrees, and no more pairs of triangles cross than before.
/// The number of triangles and the connectivity stay; border vertices do not move. The mesh must
/// outlive it and have finite coordinates. Memory: about 70 bytes per triangle, once one of them is
/// to be repaired.
class FacingRepair {
 public:
  FacingRepair(Mesh& mesh, const FacingRepairOptions& options);
  ~FacingRepair();

  /// Repairs those of these triangles that need it. `original`: what of the original is within
  /// reach of these triangles and of all others at their vertices, with finite coordinates. It may
  /// differ between calls.
  FacingMended mend(std::span<const std::uint32_t> triangles, const Mesh& original);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
