// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/vertex_normals.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

TEST_CASE("the normals of a sphere point outwards, those of a sheet up") {
  const Mesh sphere = test::icosphere(4);
  const std::vector<Vec3> normals = vertex_normals(sphere);
  REQUIRE(normals.size() == sphere.positions.size());
  for (std::size_t v = 0; v < normals.size(); ++v) {
    REQUIRE(length(normals[v]) == doctest::Approx(1));
    REQUIRE(dot(normals[v], sphere.positions[v]) > 0.9999);
  }
  for (const Vec3& normal : vertex_normals(test::grid(5, 3))) {
    CHECK(length(normal - Vec3{0, 0, 1}) < 1e-12);
  }
}

TEST_CASE("it does not matter into how many triangles a face is cut") {
  // A corner of a cube, whose face in z = 0 is cut into `many` fans.
  //
  //     3 . . 2
  //     .   / .       the other faces: one triangle each, at 0
  //     . /   .
  //     0 . . 1
  for (const int many : {1, 2, 7}) {
    CAPTURE(many);
    Mesh corner{{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    std::uint32_t last = 3;
    for (int i = 1; i <= many; ++i) {
      const double angle = std::acos(-1.0) / 2 * i / many;
      const auto next = static_cast<std::uint32_t>(corner.positions.size());
      const double far = i == many ? 1 : 3;
      corner.positions.push_back({far * std::cos(angle), far * std::sin(angle), 0});
      corner.triangles.push_back({0, last, next});
      last = next;
    }
    const Vec3 normal = vertex_normals(corner)[0];
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(normal[axis] == doctest::Approx(std::sqrt(1.0 / 3)).epsilon(2e-4));
    }
  }
}

TEST_CASE("what has no area has no normal") {
  const Mesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}}, {{0, 1, 2}, {0, 0, 1}}};
  for (const Vec3& normal : vertex_normals(line)) CHECK(normal == Vec3{});
  CHECK(vertex_normals({}).empty());
}
