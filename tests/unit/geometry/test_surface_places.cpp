// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/surface_places.hpp>

#include "geometry/bvh.hpp"
#include "geometry/random_unit.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Vec3 random_direction(std::uint64_t n) {
  return Vec3{random_unit(3 * n), random_unit(3 * n + 1), random_unit(3 * n + 2)} * 2 -
         Vec3{1, 1, 1};
}

Vec3 place_normal(const Mesh& mesh, std::uint32_t t) {
  const auto [a, b, c] = mesh.triangles[t];
  const Vec3 p = mesh.positions[a];
  return cross(mesh.positions[b] - p, mesh.positions[c] - p);
}

Vec3 point_of(const Mesh& mesh, const SurfacePlace& place) {
  const auto [a, b, c] = mesh.triangles[place.triangle];
  return mesh.positions[a] * place.shares[0] + mesh.positions[b] * place.shares[1] +
         mesh.positions[c] * place.shares[2];
}

/// The squared distance to the nearest of all triangles that face this way.
double least_squared(const Mesh& mesh, Vec3 p, Vec3 normal) {
  double least = HUGE_VAL;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!(dot(place_normal(mesh, t), normal) > 0)) continue;
    const auto [a, b, c] = mesh.triangles[t];
    least = std::min(least,
                     squared_distance(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  }
  return least;
}

/// Two sheets, one above the other: the upper one faces up, the lower one down.
Mesh wall(double thickness) {
  Mesh mesh = test::grid(10, 10);
  Mesh below = test::grid(10, 10);
  for (Vec3& p : below.positions) p.z = -thickness;
  for (Triangle& t : below.triangles) std::swap(t[1], t[2]);
  test::append(mesh, below);
  return mesh;
}

}  // namespace

TEST_CASE("the nearest place that faces the same way is found") {
  const Mesh mesh = test::torus(24, 12);
  const SurfacePlaces places(mesh, {});
  for (std::uint64_t n = 0; n < 300; ++n) {
    const Vec3 p = random_direction(2 * n) * 1.6, normal = random_direction(2 * n + 1);
    const SurfacePlace place = places.find(p, normal, static_cast<std::uint32_t>(n));
    CHECK(dot(place_normal(mesh, place.triangle), normal) > 0);
    CHECK(place.squared == doctest::Approx(least_squared(mesh, p, normal)).epsilon(1e-9));
    CHECK(squared_length(point_of(mesh, place) - p) == doctest::Approx(place.squared));
  }
}

TEST_CASE("a thin wall keeps its sides apart") {
  const Mesh mesh = wall(0.01);
  const SurfacePlaces places(mesh, {});
  for (const double z : {0.05, -0.002, -0.008, -0.05}) {
    const Vec3 p{4.2, 5.7, z};
    CHECK(places.find(p, {0, 0, 1}).triangle < 200);
    CHECK(places.find(p, {0.1, 0, -1}).triangle >= 200);
  }
}

TEST_CASE("without a place that faces the same way in reach it is the nearest of all") {
  const Mesh sheet = test::grid(10, 10);
  const SurfacePlaces places(sheet, {});
  const SurfacePlace behind = places.find({3.3, 4.6, 0.5}, {0, 0, -1});
  CHECK(behind.squared == doctest::Approx(0.25));
  CHECK(places.find({3.3, 4.6, 0.5}, {}).squared == doctest::Approx(0.25));

  const Mesh mesh = wall(1);
  const SurfacePlaces near(mesh, {.reach = 0.8});
  CHECK(near.find({5.1, 5.2, -0.1}, {0, 0, -1}).triangle < 200);
  CHECK(near.find({5.1, 5.2, -0.3}, {0, 0, -1}).triangle >= 200);
}

TEST_CASE("many points at once have the places that each has alone") {
  const Mesh mesh = test::icosphere(3);
  const SurfacePlaces places(mesh, {});
  std::vector<Vec3> points, normals;
  for (std::uint64_t n = 0; n < 200; ++n) {
    points.push_back(random_direction(n));
    normals.push_back(points.back());
  }
  std::vector<SurfacePlace> found(points.size());
  places.find(points, normals, found);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(found[i].squared == places.find(points[i], normals[i]).squared);
  }
}

TEST_CASE("what corners have is blended") {
  const SurfacePlace place{0, {0.5, 0.25, 0.25}, 0};
  const auto made = blended<2>(place, {1, 0}, {0, 1}, {0, 3});
  CHECK(made[0] == doctest::Approx(0.5));
  CHECK(made[1] == doctest::Approx(1));
}
