// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/partition/cut.hpp>

namespace meshfarm {

/// What the scans gathered of one part. Raw indices count its vertices in file order.
struct RawPart {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;      // raw indices
  std::vector<std::uint32_t> boundary;  // raw indices of boundary vertices, any order, repeats
};

struct BuiltPart {
  Part part;
  /// The boundary vertices by raw index, ascending, and the final index of each. Coincident ones
  /// share a final index.
  std::vector<std::uint32_t> boundary_raw;
  std::vector<std::uint32_t> boundary_final;
  std::uint64_t merged_vertices = 0;
  std::uint64_t dropped_degenerate = 0;
};

/// Welds, drops degenerate triangles and unused vertices, puts boundary vertices first.
BuiltPart build_part(RawPart raw, PositionType positions, Weld weld);

}  // namespace meshfarm
