// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm::test {

/// A triangle as its corners' positions, rotated so that the least comes first: the same in any
/// mesh and numbering.
using Corners = std::array<std::array<double, 3>, 3>;

inline Corners corners_of(Vec3 a, Vec3 b, Vec3 c) {
  Corners corners = {{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// All triangles of a mesh, sorted.
inline std::vector<Corners> triangles_of(const Mesh& mesh) {
  std::vector<Corners> all;
  for (const auto& [a, b, c] : mesh.triangles) {
    all.push_back(corners_of(mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace meshfarm::test
