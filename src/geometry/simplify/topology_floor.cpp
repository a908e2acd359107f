// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/topology_floor.hpp"

#include <algorithm>
#include <vector>

#include "geometry/simplify/vertex_flags.hpp"
#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

struct ComponentCounts {
  std::int64_t vertices = 0;
  std::int64_t corners = 0;
  std::int64_t border_vertices = 0;  // as many as border edges, if each is on one loop
  std::int64_t loops = 0;
  bool is_known = true;

  std::int64_t least_triangles() const {
    if (!is_known) return 1;
    const std::int64_t triangles = corners / 3;
    const std::int64_t edges = (corners + border_vertices) / 2;
    const std::int64_t euler = vertices - edges + triangles;
    // Of a closed surface, 2 V - 2 c with V = 4; of an open one, 2 V - B - 2 c with V = B = 3 b.
    const std::int64_t least = (loops == 0 ? 8 : 3 * loops) - 2 * euler;
    return std::max<std::int64_t>(1, least);
  }
};

}  // namespace

std::uint64_t least_triangles(std::span<const std::uint8_t> flags, const Adjacency& adjacency) {
  const auto vertices = static_cast<std::uint32_t>(flags.size());
  UnionFind components(vertices);
  UnionFind loops(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    for (const Corner& c : adjacency.at(v)) components.join(v, c.next);
    if ((flags[v] & k_border) == 0) continue;
    for_border_edges(adjacency.at(v),
                     [&](const Corner&, std::uint32_t end) { loops.join(v, end); });
  }
  std::vector<ComponentCounts> counts(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (adjacency.count(v) == 0) continue;
    ComponentCounts& component = counts[components.find(v)];
    ++component.vertices;
    component.corners += adjacency.count(v);
    component.is_known = component.is_known && (flags[v] & k_still) == 0;
    if ((flags[v] & k_border) == 0) continue;
    ++component.border_vertices;
    component.loops += loops.find(v) == v ? 1 : 0;
  }
  std::uint64_t least = 0;
  for (const ComponentCounts& each : counts) {
    if (each.vertices > 0) least += static_cast<std::uint64_t>(each.least_triangles());
  }
  return least;
}

}  // namespace meshfarm
