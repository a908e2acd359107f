// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/surface_walk.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "geometry/distance_across.hpp"

namespace meshfarm {
namespace {

/// Triangles farther away are found sooner from the root.
constexpr int k_most_steps = 12;
/// At most this many consecutive steps may lead away.
constexpr int k_most_detours = 2;

/// A side, stored at its lower vertex.
struct SideOfTriangle {
  std::uint32_t other = 0;  // vertex
  std::uint32_t triangle = 0;
  std::uint32_t corner = 0;  // where the side begins

  bool operator<(const SideOfTriangle& side) const {
    return other != side.other ? other < side.other : triangle < side.triangle;
  }
};

}  // namespace

SurfaceWalk::SurfaceWalk(const Mesh& mesh) : mesh_(mesh), across_(mesh.triangles.size()) {
  std::vector<std::uint32_t> first(mesh.positions.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++first[std::min(t[i], t[(i + 1) % 3]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<SideOfTriangle> sides(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[k];
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      sides[next[low]++] = {high, k, i};
    }
  }
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    const auto begin = sides.begin() + first[v], end = sides.begin() + first[v + 1];
    std::sort(begin, end);
    // If several triangles share a side, each leads to the next, and the last to the first.
    for (auto group = begin; group != end;) {
      const auto after = std::find_if(
          group, end, [&](const SideOfTriangle& side) { return side.other != group->other; });
      for (auto side = group; side != after; ++side) {
        const auto to = side + 1 == after ? group : side + 1;
        across_[side->triangle][side->corner] = to->triangle;
      }
      group = after;
    }
  }
}

Bvh::Nearest SurfaceWalk::towards(Vec3 point, std::uint32_t start, double enough) const {
  Bvh::Nearest best;
  std::uint32_t at = start;
  std::uint32_t from = start;
  int detours = 0;
  for (int step = 0; step < k_most_steps; ++step) {
    const Triangle& t = mesh_.triangles[at];
    const DistanceAcross here =
        distance_across(point, mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]);
    if (here.squared < best.squared) {
      best = {here.squared, at};
      detours = 0;
    } else if (++detours > k_most_detours) {
      break;
    }
    if (here.squared <= enough || here.is_inside()) break;
    const std::uint32_t to = across_[at][here.side];
    if (to == at || to == from) break;
    from = std::exchange(at, to);
  }
  return best;
}

}  // namespace meshfarm
