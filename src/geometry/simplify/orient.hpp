// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Turns triangles so that two that share an edge of two triangles face the same way: in each
/// piece, the way that most of its area faces, which simplifying hardly changes. A one-sided piece
/// keeps a seam. Returns how many were turned. Triangles must have three different vertices.
std::uint64_t orient(Mesh& mesh);

}  // namespace meshfarm
