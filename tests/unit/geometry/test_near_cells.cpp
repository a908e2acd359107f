// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/geometry/near_cells.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Box box_at(Vec3 p) {
  return {p, p};
}

}  // namespace

TEST_CASE("what is near a surface is found, what is far is not") {
  const Mesh mesh = test::icosphere(4);
  const NearCells near(mesh.positions, mesh.triangles, 0.1);
  CHECK(near.touch(box_at({0, 0, 1.09})));
  CHECK(near.touch(box_at({0, 0, 0.91})));
  CHECK(near.touch({{-5, -5, -5}, {5, 5, 5}}));
  CHECK_FALSE(near.touch(box_at({0, 0, 0})));
  CHECK_FALSE(near.touch(box_at({0, 0, 1.2})));
  CHECK_FALSE(near.touch(box_at({0.9, 0.9, 0.9})));
  CHECK_FALSE(near.touch({}));
}

TEST_CASE("nothing is near no surface, and a point has its surroundings") {
  CHECK_FALSE(NearCells({}, {}, 1).touch(box_at({0, 0, 0})));
  const std::vector<Vec3> positions(3, Vec3{5, 5, 5});
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  CHECK(NearCells(positions, triangles, 0).touch(box_at({5, 5, 5})));
  CHECK_FALSE(NearCells(positions, triangles, 1).touch(box_at({5, 5, 7})));
}

TEST_CASE("the triangles whose boxes touch what is near, small and large ones") {
  const Mesh near_mesh = test::icosphere(2);
  const NearCells near(near_mesh.positions, near_mesh.triangles, 0.05);
  for (const int levels : {0, 2, 5}) {
    Mesh mesh = test::icosphere(levels);
    for (Vec3& p : mesh.positions) p = p * 0.8 + Vec3{0.3, 0, 0};
    const std::vector<std::uint32_t> touching = near.touching(mesh.positions, mesh.triangles);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      Box box;
      for (const std::uint32_t v : mesh.triangles[i]) box.add(mesh.positions[v]);
      if (near.touch(box)) expected.push_back(i);
    }
    CHECK(touching == expected);
    CHECK_FALSE(touching.empty());
  }
  CHECK(NearCells({}, {}, 1).touching(near_mesh.positions, near_mesh.triangles).empty());
}
