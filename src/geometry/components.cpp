// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <meshfarm/geometry/components.hpp>

#include "geometry/union_find.hpp"

namespace meshfarm {

DroppedComponents drop_small_components(Mesh& mesh, double diagonal) {
  if (!(diagonal > 0)) return {};  // no box is smaller than nothing
  UnionFind pieces(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[1], t[2]);
  }
  std::vector<Box> boxes(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) boxes[pieces.find(corner)].add(mesh.positions[corner]);
  }
  DroppedComponents dropped;
  for (const Box& box : boxes) {
    if (!box.empty() && box.diagonal() < diagonal) ++dropped.components;
  }
  dropped.triangles = std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return boxes[pieces.find(t[0])].diagonal() < diagonal;
  });
  return dropped;
}

}  // namespace meshfarm
