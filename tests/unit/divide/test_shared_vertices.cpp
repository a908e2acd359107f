// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include "divide/shared_vertices.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("boundary vertices are found by slab and place, whatever was looked at before") {
  const test::TempFolder folder;
  SharedVertices vertices(folder.path(), 4);
  vertices.add(2, std::vector<SharedVertex>{{3, 0, 7, {1, 2, 3}}, {9, 1, 8, {4, 5, 6}}});
  vertices.add(0, std::vector<SharedVertex>{{5, 0, 0, {0, 0, 1}}});
  vertices.add(1, {});
  vertices.finish();
  for (int round = 0; round < 2; ++round) {
    CHECK(vertices.at({2, 9}).number == 1);
    CHECK(vertices.at({2, 9}).position == Vec3{4, 5, 6});
    CHECK(vertices.at({2, 3}).piece == 7);
    CHECK(vertices.at({0, 5}).position == Vec3{0, 0, 1});
    vertices.forget_below(3);
  }
}
