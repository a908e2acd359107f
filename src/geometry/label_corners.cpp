// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/label_corners.hpp>

#include "geometry/simplify/adjacency.hpp"

namespace meshfarm {
namespace {

/// Vertices with more triangles are ignored.
constexpr std::size_t k_most_counted_triangles = 1024;

std::size_t lines_at(const CornerFan& fan) {
  std::size_t lines = 0;
  for (std::size_t i = 0; i < fan.corners.size(); ++i) {
    for (std::size_t k = 0; k < fan.corners.size(); ++k) {
      if (fan.corners[k].next == fan.corners[i].prev && fan.differ(i, k)) ++lines;
    }
  }
  return lines;
}

}  // namespace

std::uint64_t count_label_corners(std::span<const Triangle> triangles,
                                  std::span<const Label> labels, std::size_t vertices) {
  if (labels.empty()) return 0;
  Adjacency adjacency;
  adjacency.build(triangles, vertices, {labels, {}});
  std::uint64_t corners = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (adjacency.count(v) > k_most_counted_triangles) continue;
    const std::size_t lines = lines_at(adjacency.fan_at(v));
    corners += lines != 0 && lines != 2 ? 1 : 0;
  }
  return corners;
}

}  // namespace meshfarm
