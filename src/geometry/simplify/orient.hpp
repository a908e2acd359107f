// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Turns triangles so that two that share an edge of two triangles face the same way, in each piece
/// the way that most of its triangles do. A piece that has but one side keeps a seam. Returns how
/// many were turned. Triangles have three different vertices, and texture coordinates or none.
std::uint64_t orient(std::vector<Triangle>& triangles, std::span<CornerUvs> uvs = {});

}  // namespace meshfarm
