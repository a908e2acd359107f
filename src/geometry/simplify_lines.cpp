// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify_lines.hpp"

#include <cmath>
#include <numbers>

namespace meshfarm {

CreaseTest::CreaseTest(double degrees) {
  const double cosine = std::cos(degrees * std::numbers::pi / 180);
  cosine_squared_ = cosine * std::abs(cosine);
}

void CreaseLines::find(const Mesh& mesh, const Adjacency& adjacency,
                       std::vector<std::uint8_t>& flags) const {
  if (!exists_) return;
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    // Of an edge between two vertices each end sees it; one of them is enough.
    const auto is_greater = [v](std::uint32_t end) { return end > v; };
    for_crease_edges(adjacency.at(v), mesh.positions[v], mesh.positions, sharp_, is_greater,
                     [&](const Corner& one, const Corner&) {
                       flags[v] |= k_crease;
                       flags[one.prev] |= k_crease;
                     });
  }
  update(mesh, adjacency, flags);
}

void CreaseLines::update(const Mesh& mesh, const Adjacency& adjacency,
                         std::vector<std::uint8_t>& flags) const {
  if (!exists_) return;
  const std::vector<std::uint8_t> before = flags;
  const auto is_on_crease = [&](std::uint32_t end) { return (before[end] & k_crease) != 0; };
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    if (!is_on_crease(v)) continue;
    int creases = 0;
    for_crease_edges(adjacency.at(v), mesh.positions[v], mesh.positions, still_sharp_, is_on_crease,
                     [&](const Corner&, const Corner&) { ++creases; });
    flags[v] &= static_cast<std::uint8_t>(~(k_crease | k_corner));
    if (creases == 0) continue;
    flags[v] |= k_crease;
    if (creases != 2 || (flags[v] & k_border) != 0) flags[v] |= k_corner;
  }
}

}  // namespace meshfarm
