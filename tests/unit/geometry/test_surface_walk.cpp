// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include "geometry/bvh.hpp"
#include "geometry/surface_walk.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Mesh hilly_sheet() {
  Mesh mesh = test::grid(30, 30);
  for (Vec3& p : mesh.positions) p.z = std::sin(p.x * 0.2) + std::cos(p.y * 0.3);
  return mesh;
}

}  // namespace

TEST_CASE("surface walk: comes to the nearest triangle of a smooth surface") {
  const Mesh mesh = hilly_sheet();
  const SurfaceWalk walk(mesh);
  const Bvh bvh(mesh, 1);
  std::uint32_t at = 0;
  for (double x = 0.3; x < 29; x += 0.7) {
    const Vec3 point{x, 0.9 * x, std::sin(x * 0.2) + std::cos(0.9 * x * 0.3) + 0.1};
    const Bvh::Nearest found = walk.towards(point, at, 0);
    at = found.triangle;
    CHECK(found.squared == doctest::Approx(bvh.nearest(point, 0).squared).epsilon(1e-9));
  }
}

TEST_CASE("surface walk: stops at a border, where it is near enough, and after some steps") {
  const Mesh mesh = hilly_sheet();
  const SurfaceWalk walk(mesh);
  CHECK(walk.towards({-9, -9, 0}, 0, 0).squared > 100);
  CHECK(walk.towards({29, 29, 0}, 0, 0).squared > 100);
  CHECK(walk.towards({2, 2, 0}, 0, 1e9).triangle == 0);
}

TEST_CASE("surface walk: goes on across sides that several triangles share") {
  Mesh mesh = test::grid(4, 1);
  const std::size_t before = mesh.triangles.size();
  for (std::size_t i = 0; i < before; ++i) mesh.triangles.push_back(mesh.triangles[i]);
  const SurfaceWalk walk(mesh);
  for (std::uint32_t from = 0; from < mesh.triangles.size(); ++from) {
    CHECK(walk.towards({2, 0.5, 1}, from, 0).squared < 100);
  }
}

TEST_CASE("any triangle within a distance is told if there is one") {
  const Mesh mesh = hilly_sheet();
  const Bvh bvh(mesh, 1);
  for (double x = -3; x < 33; x += 0.9) {
    const Vec3 point{x, 12, 4 * std::sin(x)};
    const double squared = bvh.nearest(point, 0).squared;
    CHECK(bvh.any_within(point, squared * 1.001).squared <= squared * 1.001);
    CHECK(std::isinf(bvh.any_within(point, squared * 0.999).squared));
  }
}
