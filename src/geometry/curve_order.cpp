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
  std::vector<MortonItem> items(mesh.triangles.size());
  for (std::size_t t = 0; t < items.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) * (1.0 / 3);
    items[t] = {morton_code((middle - center) * scale), static_cast<std::uint32_t>(t)};
  }
  sort_by_code(items);
  return numbers_of(items);
}

}  // namespace meshfarm
