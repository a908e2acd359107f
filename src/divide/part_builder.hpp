// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/part_file.hpp>

#include "divide/mesh_shares.hpp"

namespace meshfarm {

struct BuiltPart {
  Part part;
  BoundaryNumbers boundary;
  std::uint64_t coincident_vertices = 0;  // at the place of an earlier one, merged or not
  std::uint64_t dropped_degenerate = 0;
  std::uint64_t coincident_corners = 0;  // triangles with two corners at one place
};

/// Welds, drops degenerate triangles and unused vertices, puts boundary vertices first.
BuiltPart build_part(MeshShare raw, PositionType positions, Weld weld);

}  // namespace meshfarm
