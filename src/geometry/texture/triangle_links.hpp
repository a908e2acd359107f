// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

inline constexpr std::uint32_t k_no_triangle = 0xffffffff;

/// The triangle across each side of a triangle, or k_no_triangle; side k goes from corner k to the
/// next one.
using TriangleLinks = std::array<std::uint32_t, 3>;

/// Links triangles that share an edge and have the same orientation. If an edge has more than two
/// triangles, those with the most similar normals are linked, in pairs. `normals` have length 1, or
/// 0.
std::vector<TriangleLinks> link_triangles(const Mesh& mesh, std::span<const Vec3> normals);

}  // namespace meshfarm
