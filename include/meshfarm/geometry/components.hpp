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
/// `diagonal`. All vertices stay, used or not. Triangles must name vertices that exist.
DroppedComponents drop_small_components(Mesh& mesh, double diagonal);

/// For each of the `vertices`, the lowest vertex that triangles connect it to; itself if it has no
/// triangles. Triangles must name vertices that exist.
std::vector<std::uint32_t> lowest_connected(std::size_t vertices,
                                            std::span<const Triangle> triangles);

/// Number and total area of components that are gone.
struct GoneComponents {
  std::uint64_t components = 0;
  double area = 0;
  double area_of_all = 0;
};

/// The components of `before` that have no remainder in `after`. Each component of `after` counts
/// as the remainder of the component of `before` that most of it is nearest to, by the area of some
/// of its triangles. A component with at least a twentieth of the area is also still there if most
/// of it is less than half as far from `after` as from the other components. Both meshes need
/// finite coordinates, and `before` a triangle. Vertices without triangles do not count.
GoneComponents find_gone_components(const Mesh& before, const Mesh& after, unsigned threads);

}  // namespace meshfarm
