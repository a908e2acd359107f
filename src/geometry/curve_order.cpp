// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/curve_order.hpp>

#include "geometry/bvh_morton.hpp"

namespace meshfarm {

std::vector<std::uint32_t> along_a_curve(const Mesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  const double side = box.diagonal();
  const double scale = side > 0 ? 1 / side : 0;
  const Vec3 center = (box.lo + box.hi) * 0.5;
  const auto middle_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) * (1.0 / 3);
  };
  std::vector<MortonItem> items(mesh.triangles.size());
  for (std::uint32_t t = 0; t < items.size(); ++t) {
    items[t] = {morton_code((middle_of(t) - center) * scale), t};
  }
  sort_along_curve(items, middle_of);
  return numbers_of(items);
}

}  // namespace meshfarm
