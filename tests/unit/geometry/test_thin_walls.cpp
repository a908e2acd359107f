// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/simplify/thin_walls.hpp"
#include "geometry/simplify/vertex_flags.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::size_t thin_vertices(const Mesh& mesh, double reach) {
  std::vector<std::uint8_t> flags(mesh.positions.size(), 0);
  flag_thin_walls(mesh, reach, flags);
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), k_thin));
}

/// A sheet and, so far above it, one that faces the other way or the same.
Mesh two_sheets(double apart, bool is_turned) {
  Mesh mesh = test::grid(20, 20);
  const Mesh first = mesh;
  const auto count = static_cast<std::uint32_t>(first.positions.size());
  for (const Vec3& p : first.positions) mesh.positions.push_back(p + Vec3{0, 0, apart});
  for (Triangle t : first.triangles) {
    if (is_turned) std::swap(t[1], t[2]);
    mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return mesh;
}

}  // namespace

TEST_CASE("thin walls: sheets that face each other within reach") {
  const Mesh wall = two_sheets(2, true);
  CHECK(thin_vertices(wall, 2) == wall.positions.size());
  CHECK(thin_vertices(wall, 0.9) == 0);
  CHECK(thin_vertices(two_sheets(2, false), 2) == 0);
  CHECK(thin_vertices(test::icosphere(4), 0.1) == 0);
}

TEST_CASE("thin walls: what is no surface has none") {
  CHECK(thin_vertices({}, 1) == 0);
  CHECK(thin_vertices(two_sheets(1, true), 0) == 0);
  Mesh broken = two_sheets(1, true);
  broken.positions[0].x = std::numeric_limits<double>::infinity();
  broken.positions[1].y = std::numeric_limits<double>::quiet_NaN();
  CHECK(thin_vertices(broken, 1) > 0);
}
