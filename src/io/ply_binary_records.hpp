// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>

#include <meshfarm/geometry/vec.hpp>
#include <meshfarm/io/mesh_source.hpp>

#include "ply_header.hpp"

namespace meshfarm {

/// Vertex records of one size: where the coordinates are in them.
struct VertexLayout {
  std::size_t record_bytes = 0;
  std::array<std::size_t, 3> offsets{};
  std::array<PlyType, 3> types{};
};

/// `element` must have no lists.
VertexLayout vertex_layout(const PlyElement& element);

/// Decodes as many records as `out` has room for.
template <std::endian Order>
void decode_vertices(const VertexLayout& layout, const char* records, std::span<Vec3> out);

/// Face records of triangles. Their lists are the corners and possibly another one of six values,
/// as texture coordinates have.
struct TriangleLayout {
  struct Six {
    std::size_t offset = 0;  // of its count
    PlyType count_type = PlyType::uint8;
    PlyType type = PlyType::float32;
  };
  std::size_t record_bytes = 0;
  std::size_t list_offset = 0;
  std::size_t count_bytes = 0;          // 1, 2 or 4
  PlyType index_type = PlyType::int32;  // int32 or uint32
  std::size_t label_offset = 0;         // if they have labels
  PlyType label_type = PlyType::int32;
  std::optional<Six> six;
};

/// Nothing if the records are of another kind.
std::optional<TriangleLayout> triangle_layout(const PlyElement& element);

/// Decodes records up to the first that is no triangle, has an index out of range, or has other
/// than six values in a list that must have six. Returns how many.
template <std::endian Order>
std::size_t decode_triangles(const TriangleLayout& layout, const char* records,
                             std::uint64_t vertices, std::span<WideTriangle> out);

/// The labels of as many records as `out` has room for.
template <std::endian Order>
void decode_labels(const TriangleLayout& layout, const char* records, std::span<Label> out);

/// The six values of as many records, as texture coordinates; values that are not finite become 0.
template <std::endian Order>
void decode_uvs(const TriangleLayout& layout, const char* records, std::span<CornerUvs> out);

/// A whole number as stored in a file; negative ones wrap around.
template <std::endian Order>
Label load_label(PlyType type, const char* bytes) {
  return with_ply_value<Order>(type, bytes, [](auto value) { return static_cast<Label>(value); });
}

}  // namespace meshfarm
