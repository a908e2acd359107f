// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

struct DroppedComponents {
  std::uint64_t components = 0;
  std::uint64_t triangles = 0;
};

/// Removes the triangles of every connected component whose bounding box has a diagonal below
/// `diagonal`. Vertices stay where they are, used or not. Triangles must name vertices that exist.
DroppedComponents drop_small_components(Mesh& mesh, double diagonal);

/// Of each of so many vertices the lowest that triangles connect it with; of one without triangles
/// itself. Triangles must name vertices that exist.
std::vector<std::uint32_t> lowest_connected(std::size_t vertices,
                                            std::span<const Triangle> triangles);

/// What a connected component is by size.
struct GoneComponents {
  std::uint64_t components = 0;
  double area = 0;
  double area_of_all = 0;
};

/// Those components of `before` that no component of `after` is what is left of: each is taken for
/// what is left of the one that most of it is nearest to, by the area of some of its triangles. One
/// with a twentieth of the area is there, too, if most of it is less than half as far from `after`
/// as from the others. Both meshes need finite coordinates, and `before` a triangle. Vertices
/// without triangles count for nothing.
GoneComponents find_gone_components(const Mesh& before, const Mesh& after, unsigned threads);

}  // namespace meshfarm
