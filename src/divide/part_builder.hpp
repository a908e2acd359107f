// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/divide/weld_counts.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/slab_file.hpp>

#include "divide/boundary_numbers.hpp"

namespace meshfarm {

struct BuiltPart : WeldCounts {
  Part part;
  BoundaryNumbers boundary;
};

/// Welds, drops degenerate triangles and unused vertices, puts boundary vertices first.
BuiltPart build_part(MeshShare raw, Weld weld);

}  // namespace meshfarm
