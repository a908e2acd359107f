// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

// What the formats of staged files share.

/// Fails if a corner is not below `vertices`.
void check_corners(const ByteReader& in, std::size_t vertices, std::span<const Triangle> triangles);

/// Positions as float32 or float64. Those that are read must be finite.
void put_positions(ByteWriter& out, std::span<const Vec3> points, PositionType positions);
std::vector<Vec3> get_positions(ByteReader& in, std::uint64_t count, PositionType positions);

PositionType get_position_type(ByteReader& in);

}  // namespace meshfarm
