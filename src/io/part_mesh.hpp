// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// A mesh within a staged file: positions as float32 or float64, then triangles as u32 triples.
void put_mesh(ByteWriter& out, const Mesh& mesh, PositionType positions);
/// Checks that coordinates are finite and indices in range.
Mesh get_mesh(ByteReader& in, std::uint64_t vertices, std::uint64_t triangles,
              PositionType positions);

/// Fails if a corner is none of so many vertices.
void check_corners(const ByteReader& in, std::size_t vertices, std::span<const Triangle> triangles);

/// The positions alone.
void put_positions(ByteWriter& out, std::span<const Vec3> points, PositionType positions);
std::vector<Vec3> get_positions(ByteReader& in, std::uint64_t count, PositionType positions);

PositionType get_position_type(ByteReader& in);

}  // namespace meshfarm
