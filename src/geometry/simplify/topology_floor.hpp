// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "geometry/simplify/adjacency.hpp"

namespace meshfarm {

/// A lower limit of the triangles that a mesh has while its topology is kept, from the counts of
/// each component (Euler). With V vertices, B border edges in b loops and Euler characteristic c, a
/// surface has 2 V - B - 2 c triangles. A loop has at least three vertices, all different, and a
/// closed surface at least four. A component with fixed or complex vertices may have one triangle.
/// `flags` (VertexFlag) and `adjacency` are of the same vertices.
std::uint64_t least_triangles(std::span<const std::uint8_t> flags, const Adjacency& adjacency);

}  // namespace meshfarm
