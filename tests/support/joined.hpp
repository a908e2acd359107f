// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/part_file.hpp>

namespace meshfarm::test {

/// Joins parts, or streams that were read completely, and the triangles between them to one mesh.
inline Mesh joined(std::span<const Part> parts, std::span<const BoundaryTriangle> boundary) {
  Mesh whole;
  std::vector<std::uint32_t> offsets;
  for (const Part& part : parts) {
    const auto offset = static_cast<std::uint32_t>(whole.positions.size());
    offsets.push_back(offset);
    const std::vector<Vec3>& positions = part.mesh.positions;
    whole.positions.insert(whole.positions.end(), positions.begin(), positions.end());
    for (const auto& [a, b, c] : part.mesh.triangles) {
      whole.triangles.push_back({a + offset, b + offset, c + offset});
    }
  }
  const auto at = [&](BoundaryCorner c) { return offsets[c.part] + c.local; };
  for (const auto& [a, b, c] : boundary) whole.triangles.push_back({at(a), at(b), at(c)});
  return whole;
}

/// The number of vertices at the point of an earlier one.
inline std::uint64_t count_coincident(const Mesh& mesh) {
  return weld(mesh.positions).merged;
}

/// The number of triangles with two corners at one point.
inline std::uint64_t count_flat(const Mesh& mesh) {
  const std::vector<Vec3>& at = mesh.positions;
  return static_cast<std::uint64_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        return at[t[0]] == at[t[1]] || at[t[1]] == at[t[2]] || at[t[2]] == at[t[0]];
      }));
}

/// The mesh with its vertices and triangles in another order, and the corners of triangles rotated.
inline Mesh shuffled(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), random);
  Mesh made;
  made.positions.resize(order.size());
  for (std::size_t v = 0; v < order.size(); ++v) made.positions[order[v]] = mesh.positions[v];
  for (Triangle t : mesh.triangles) {
    t = {order[t[0]], order[t[1]], order[t[2]]};
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    made.triangles.push_back(t);
  }
  std::shuffle(made.triangles.begin(), made.triangles.end(), random);
  return made;
}

}  // namespace meshfarm::test
