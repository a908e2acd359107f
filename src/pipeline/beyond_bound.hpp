// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Simplification looks at some points. Where others turn out to be beyond so many times the bound
/// that it was given, what is near stays as it was, and it begins again; so often, all in all.
inline constexpr double k_most_beyond = 1.2;
inline constexpr int k_bounded_tries = 4;

/// Of a triangle, beside its corners and the middle of its longest side.
enum class PointsInside : std::uint8_t { none, some };

/// Those triangles of a surface, with an area, of which a point that is looked at is farther from
/// another surface than that. Cheap where there are none.
Mesh part_beyond(const Mesh& from, PointsInside points, const Mesh& to, double distance,
                 unsigned threads);

/// Clears the flags of vertices within the distance of the surface.
void clear_near(const Mesh& surface, double distance, const std::vector<Vec3>& positions,
                std::vector<std::uint8_t>& flags);

}  // namespace meshfarm
