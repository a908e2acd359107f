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
