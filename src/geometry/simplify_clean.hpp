// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "geometry/adjacency.hpp"

namespace meshfarm {

/// What a vertex may do, one byte each; a merged vertex inherits all but that it is fixed.
enum VertexFlag : std::uint8_t {
  k_fixed = 1,   // neither moves nor goes, and no edge at it collapses
  k_border = 2,  // on an edge that has one triangle
  k_seam = 4,    // SimplifyOptions::seam
  k_crease = 8,  // on an edge sharper than LineOptions::crease_angle
  k_corner = 16  // where creases meet or end
};

/// Throws UsageError or DataError if options or mesh cannot be taken.
void check_input(const Mesh& mesh, const SimplifyOptions& options);

struct Dropped {
  std::uint64_t degenerate = 0;
  std::uint64_t duplicate = 0;
};

/// What a mesh is made of, once it is clean.
struct Surface {
  Dropped dropped;
  std::vector<std::uint8_t> flags;  // VertexFlag
};

/// Drops triangles with two equal corners, then those with the vertices of an earlier one, and
/// flags the vertices. Leaves `adjacency` built for what is left.
///
/// Fixed are the locked, those that are not finite, and those whose triangles do not make one
/// consistently oriented fan: ends of non-manifold edges, bow ties.
Surface clean_surface(Mesh& mesh, const SimplifyOptions& options, Adjacency& adjacency);

}  // namespace meshfarm
