// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/adjacency.hpp"

namespace meshfarm {

void Adjacency::build(std::span<const Triangle> triangles, std::size_t vertices) {
  // Row v is counted in offsets_[v + 2] and filled through offsets_[v + 1], which then ends it.
  offsets_.assign(vertices + 2, 0);
  corners_.resize(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) ++offsets_[v + 2];
  }
  for (std::size_t v = 2; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
  for (const Triangle& t : triangles) {
    corners_[offsets_[t[0] + 1]++] = {t[1], t[2]};
    corners_[offsets_[t[1] + 1]++] = {t[2], t[0]};
    corners_[offsets_[t[2] + 1]++] = {t[0], t[1]};
  }
}

}  // namespace meshfarm
