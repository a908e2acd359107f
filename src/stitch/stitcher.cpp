// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <limits>
#include <string>

#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

void Stitcher::add(const ResultMesh& part) {
  Mesh& mesh = stitched_.mesh;
  const std::size_t first = mesh.positions.size();
  if (first + part.mesh.positions.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw DataError("the stitched mesh would have 2^32 vertices or more; ask for fewer triangles");
  }
  const auto offset = static_cast<std::uint32_t>(first);
  first_vertex_.push_back(offset);
  boundary_vertices_.push_back(part.boundary_vertices);
  mesh.positions.insert(mesh.positions.end(), part.mesh.positions.begin(),
                        part.mesh.positions.end());
  for (const Triangle& t : part.mesh.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  stitched_.seam.resize(first + part.boundary_vertices, 1);
  stitched_.seam.resize(mesh.positions.size(), 0);
}

StitchedMesh Stitcher::finish(std::span<const BoundaryTriangle> boundary) {
  const auto vertex = [&](const BoundaryCorner& corner) {
    if (corner.part >= first_vertex_.size() || corner.local >= boundary_vertices_[corner.part]) {
      throw DataError("a boundary triangle names vertex " + std::to_string(corner.local) +
                      " of part " + std::to_string(corner.part) +
                      ", which is no boundary vertex there; cut the mesh again");
    }
    return first_vertex_[corner.part] + corner.local;
  };
  for (const BoundaryTriangle& t : boundary) {
    stitched_.mesh.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
  }
  return std::move(stitched_);
}

}  // namespace meshfarm
