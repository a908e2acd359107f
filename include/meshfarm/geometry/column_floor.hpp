// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// About the least that simplification can reach as long as columns are kept. The floors of a
/// mesh's parts add up to that of the mesh, except for what lies between the parts.
struct ColumnFloor {
  /// Vertices that cannot move: those where one line ends, or more than two (lines between labels
  /// or seams of texture coordinates), or where a line meets a border.
  std::uint64_t corners = 0;
  /// Triangles left if each chart (a region enclosed by lines) keeps only these vertices: two fewer
  /// than the vertices on its rim, but at least one.
  std::uint64_t triangles = 0;

  ColumnFloor& operator+=(const ColumnFloor& other) {
    corners += other.corners;
    triangles += other.triangles;
    return *this;
  }
};

/// Zero if the mesh has no columns of the set. The first `locked` vertices, which a part shares
/// with other parts, are not corners.
ColumnFloor find_column_floor(const Mesh& mesh, const ColumnSet& columns, std::size_t locked = 0);

}  // namespace meshfarm
