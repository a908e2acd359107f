// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {

/// Throws UsageError or DataError if the options or the mesh cannot be accepted.
void check_input(const Mesh& mesh, const SimplifyOptions& options);

struct Dropped {
  std::uint64_t degenerate = 0;
  std::uint64_t duplicate = 0;
  std::uint64_t turned = 0;  // not dropped, but made to face the other way
};

/// What is known about a mesh once it is clean.
struct Surface {
  Dropped dropped;
  std::vector<std::uint8_t> flags;  // VertexFlag
};

/// Drops triangles with two equal corners, then those with the same vertices as an earlier one;
/// turns triangles that face another way than their neighbours; splits vertices where closed fans
/// touch; and flags the vertices. Leaves `adjacency` built for what is left.
///
/// Vertices that are locked or not finite are flagged as fixed.
Surface clean_surface(Mesh& mesh, const SimplifyOptions& options, Adjacency& adjacency);

}  // namespace meshfarm
