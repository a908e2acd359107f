// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A corner of a triangle: 3 x triangle + its place there. Columns are looked up by it.
using CornerId = std::uint32_t;

constexpr CornerId next_corner(CornerId id) {
  return id % 3 == 2 ? id - 2 : id + 1;
}
constexpr CornerId prev_corner(CornerId id) {
  return id % 3 == 0 ? id + 2 : id - 1;
}

inline const Uv& uv_of(std::span<const CornerUvs> uvs, CornerId id) {
  return uvs[id / 3][id % 3];
}
inline Uv& uv_of(std::span<CornerUvs> uvs, CornerId id) {
  return uvs[id / 3][id % 3];
}

/// Corners of one vertex with the same bits are one wedge.
inline bool is_same(const Uv& a, const Uv& b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Whether an edge is a line between labels. At one end of the edge, `ends` is the corner of the
/// triangle that ends at the edge, `begins` that of the triangle that begins there.
inline bool are_of_two_labels(const TriangleColumnsView& columns, CornerId ends, CornerId begins) {
  return !columns.labels.empty() && columns.labels[ends / 3] != columns.labels[begins / 3];
}

/// Whether an edge is a line between labels, or a seam of texture coordinates.
inline bool are_apart(const TriangleColumnsView& columns, CornerId ends, CornerId begins) {
  if (are_of_two_labels(columns, ends, begins)) return true;
  if (columns.uvs.empty()) return false;
  return !is_same(uv_of(columns.uvs, ends), uv_of(columns.uvs, begins)) ||
         !is_same(uv_of(columns.uvs, prev_corner(ends)), uv_of(columns.uvs, next_corner(begins)));
}

}  // namespace meshfarm
