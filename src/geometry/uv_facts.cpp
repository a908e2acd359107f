// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <meshfarm/geometry/column_floor.hpp>
#include <meshfarm/geometry/uv_facts.hpp>

namespace meshfarm {

double uv_area(const CornerUvs& uvs) {
  const auto side = [&](std::size_t to, std::size_t axis) {
    return static_cast<double>(uvs[to][axis]) - static_cast<double>(uvs[0][axis]);
  };
  return 0.5 * std::abs(side(1, 0) * side(2, 1) - side(2, 0) * side(1, 1));
}

double UvFacts::side() const {
  const double side = picture > 0 ? std::sqrt(surface / picture) : 0;
  return std::isfinite(side) ? side : 0;
}

std::uint64_t told_uv_floor(std::uint64_t floor) {
  constexpr double k_room = 1.2;
  return static_cast<std::uint64_t>(k_room * static_cast<double>(floor));
}

UvFacts find_uv_facts(const Mesh& mesh, std::size_t locked) {
  UvFacts facts;
  if (mesh.columns.uvs.empty()) return facts;
  facts.floor = find_column_floor(mesh, mesh.columns.set(), locked).triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Vec3 normal =
        cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    facts.surface += 0.5 * length(normal);
    facts.picture += uv_area(mesh.columns.uvs[i]);
  }
  return facts;
}

}  // namespace meshfarm
