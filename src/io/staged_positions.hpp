// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

// Shared by the formats of staged files.

/// Fails if a corner is not below `vertices`.
void check_corners(const ByteReader& in, std::size_t vertices, std::span<const Triangle> triangles);

/// Positions as float32 or float64. Those read must be finite.
void put_positions(ByteWriter& out, std::span<const Vec3> points, PositionType positions);
std::vector<Vec3> get_positions(ByteReader& in, std::uint64_t count, PositionType positions);

PositionType get_position_type(ByteReader& in);

/// The vertex format, as one byte: 4 or 8 for the type of the positions, plus 16 if vertices have
/// appearances, plus 32 if triangles have labels, plus 64 if they have texture coordinates.
struct VertexFormat {
  PositionType positions = PositionType::float32;
  bool appearances = false;
  ColumnSet columns = {};     // of the triangles
  std::size_t bytes() const;  // of one vertex
};
void put_vertex_format(ByteWriter& out, VertexFormat format);
VertexFormat get_vertex_format(ByteReader& in);
/// Nothing for an invalid byte.
std::optional<VertexFormat> vertex_format_of(std::uint8_t byte);

/// All labels, u32 each, then all texture coordinates, 6 x f32 each.
void put_columns(ByteWriter& out, const TriangleColumnsView& columns);
/// Appends them. Fails for texture coordinates that are not finite.
void get_columns(ByteReader& in, std::uint64_t triangles, const ColumnSet& set,
                 TriangleColumns& columns);

/// All positions, then all appearances.
void put_vertices(ByteWriter& out, const VertexView& vertices, VertexFormat format);
/// Appends the vertices that follow.
void get_vertices(ByteReader& in, std::uint64_t count, VertexFormat format,
                  std::vector<Vec3>& positions, std::vector<Appearance>& appearances);

}  // namespace meshfarm
