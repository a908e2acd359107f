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
  k_fixed = 1,    // neither moves nor goes
  k_border = 2,   // on an edge that has one triangle
  k_seam = 4,     // SimplifyOptions::seam
  k_crease = 8,   // on an edge sharper than LineOptions::crease_angle
  k_corner = 16,  // where creases meet or end
  k_complex = 32  // its triangles are not one consistently oriented fan
};

/// Passes leave the edges at these vertices alone.
constexpr std::uint8_t k_still = k_fixed | k_complex;

/// Throws UsageError or DataError if options or mesh cannot be taken.
void check_input(const Mesh& mesh, const SimplifyOptions& options);

struct Dropped {
  std::uint64_t degenerate = 0;
  std::uint64_t duplicate = 0;
  std::uint64_t turned = 0;  // not dropped, but made to face the other way
};

/// What a mesh is made of, once it is clean.
struct Surface {
  Dropped dropped;
  std::vector<std::uint8_t> flags;  // VertexFlag
};

/// Drops triangles with two equal corners, then those with the vertices of an earlier one; turns
/// triangles that face another way than their neighbours; takes vertices apart where closed fans
/// touch; and flags the vertices. Leaves `adjacency` built for what is left.
///
/// Fixed are the locked and those that are not finite.
Surface clean_surface(Mesh& mesh, const SimplifyOptions& options, Adjacency& adjacency);

}  // namespace meshfarm
