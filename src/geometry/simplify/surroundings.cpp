// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/surroundings.hpp"

#include <algorithm>
#include <utility>

namespace meshfarm {

double Surroundings::squared_distance(const ShrinkingMesh& mesh, Vec3 from,
                                      std::span<const std::uint32_t> without) {
  if (!index_) list_vertices(mesh);
  return index_->squared_distance(from, [&](std::uint32_t point) {
    std::uint32_t v = vertices_[point];
    while (mesh.target[v] != v) v = mesh.target[v];
    return mesh.adjacency->count(v) > 0 && !std::binary_search(without.begin(), without.end(), v);
  });
}

void Surroundings::list_vertices(const ShrinkingMesh& mesh) {
  std::vector<Vec3> points;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.target[v] != v || mesh.adjacency->count(v) == 0) continue;
    points.push_back(mesh.positions[v]);
    vertices_.push_back(v);
  }
  index_.emplace(std::move(points));
}

}  // namespace meshfarm
