// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// What simplification cannot go below as long as columns are kept, about. Those of parts of a mesh
/// add up to that of the mesh, but for what lies between them.
struct ColumnFloor {
  /// Vertices that stay where they are: those where more or fewer than two lines end, lines between
  /// labels or seams of texture coordinates, but at least one; or where a line meets a border.
  std::uint64_t corners = 0;
  /// Triangles that are left if each chart, which is what lines enclose, keeps no other vertices
  /// than these: two less than those on its rim, but at least one.
  std::uint64_t triangles = 0;

  ColumnFloor& operator+=(const ColumnFloor& other) {
    corners += other.corners;
    triangles += other.triangles;
    return *this;
  }
};

/// Without columns of the set the floor is nothing. The first `locked` vertices, which a part has
/// in common with others, are no corners.
ColumnFloor find_column_floor(const Mesh& mesh, const ColumnSet& columns, std::size_t locked = 0);

}  // namespace meshfarm
