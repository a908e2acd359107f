// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

struct DroppedComponents {
  std::uint64_t components = 0;
  std::uint64_t triangles = 0;
};

/// Removes the triangles of every connected component whose bounding box has a diagonal below
/// `diagonal`. Vertices stay where they are, used or not. Triangles must name vertices that exist.
DroppedComponents drop_small_components(Mesh& mesh, double diagonal);

}  // namespace meshfarm
