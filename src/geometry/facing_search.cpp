// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/facing_repair.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "geometry/turned.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_at_once = 4'096;

}  // namespace

std::vector<std::uint32_t> find_opposed_triangles(const TriangleIndex& index, double reach,
                                                  unsigned threads) {
  const Mesh& mesh = index.mesh();
  std::vector<std::uint8_t> opposed(mesh.triangles.size(), 0);
  const std::uint64_t chunks = (opposed.size() + k_at_once - 1) / k_at_once;
  parallel_for(chunks, threads, [&](std::uint64_t chunk) {
    const std::uint64_t end = std::min<std::uint64_t>(opposed.size(), (chunk + 1) * k_at_once);
    for (std::uint64_t i = chunk * k_at_once; i < end; ++i) {
      const auto triangle = static_cast<std::uint32_t>(i);
      const auto& [a, b, c] = mesh.triangles[i];
      const Vec3 center = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) * (1.0 / 3);
      const Bvh::Nearest against = index.bvh().nearest_facing(
          center, normal_of(mesh, triangle) * -1.0, triangle, reach * reach);
      opposed[i] = std::isfinite(against.squared) ? 1 : 0;
    }
  });
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < opposed.size(); ++i) {
    if (opposed[i] != 0) found.push_back(i);
  }
  return found;
}

}  // namespace meshfarm
