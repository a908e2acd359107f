// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/near_misses.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Box box_around(const Mesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  return box;
}

/// In units of the diagonal.
double distance_in(const Mesh& mesh) {
  const Box box = box_around(mesh);
  NearMisses misses(box);
  const std::span<const Vec3> all(mesh.positions);
  const std::size_t half = all.size() / 2;
  misses.add(all.first(half));
  misses.add(all.subspan(half));
  if (!misses.look()) return 0;
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (const Triangle& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  misses.add(triangles);
  return misses.distance() / box.diagonal();
}

Mesh times(Mesh mesh, double by) {
  for (Vec3& p : mesh.positions) p = p * by;
  return mesh;
}

}  // namespace

TEST_CASE("NearMisses: a surface, in one piece or with corners of their own, has none") {
  CHECK(distance_in({}) == 0);
  CHECK(distance_in(test::torus(60, 40)) == 0);
  CHECK(distance_in(test::jittered_soup(test::torus(60, 40), 0)) == 0);
  CHECK(distance_in(times(test::icosphere(3), 0)) == 0);
}

TEST_CASE("NearMisses: the distance covers corners that were moved, and is not much more") {
  const Mesh torus = test::torus(60, 40);
  const double diagonal = box_around(torus).diagonal();
  for (const double by : {1e-12, 1e-9, 6e-8, 3e-7}) {
    CAPTURE(by);
    const double found = distance_in(test::jittered_soup(torus, by * diagonal));
    CHECK(found > 2 * 1.7320508 * by);  // the greatest distance of two corners
    CHECK(found < 20 * by);
    CHECK(found <= NearMisses::k_most_of_diagonal);
  }
  // Few triangles, and so many that a sample has to do.
  CHECK(distance_in(test::jittered_soup(test::box({1, 2, 3}), 1e-8)) > 0);
  const Mesh fine = test::jittered_soup(test::icosphere(7), 1e-8);
  REQUIRE(fine.positions.size() > 900'000);
  CHECK(distance_in(fine) > 1e-8);
}

TEST_CASE("NearMisses: a few corners that were moved count, if they are more than a few") {
  const Mesh torus = test::torus(60, 40);
  Mesh moved = test::jittered_soup(torus, 1e-7);
  const Mesh exact = test::jittered_soup(torus, 0);
  std::mt19937 random(2);
  for (std::size_t v = 0; v < moved.positions.size(); ++v) {
    if (random() % 20 != 0) moved.positions[v] = exact.positions[v];
  }
  CHECK(distance_in(moved) > 1e-7);
  for (std::size_t v = 9; v < moved.positions.size(); ++v) moved.positions[v] = exact.positions[v];
  CHECK(distance_in(moved) == 0);
}

TEST_CASE("NearMisses: the order of vertices and triangles does not matter") {
  Mesh soup = test::jittered_soup(test::torus(200, 200), 1e-7);  // a sample has to do
  const double found = distance_in(soup);
  CHECK(found > 0);
  std::shuffle(soup.triangles.begin(), soup.triangles.end(), std::mt19937(1));
  std::reverse(soup.positions.begin(), soup.positions.end());
  for (Triangle& t : soup.triangles) {
    for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(soup.positions.size()) - 1 - v;
  }
  CHECK(distance_in(soup) == found);
}

TEST_CASE("NearMisses: small things in a large mesh are no misses") {
  // As small as a corner's miss, and with nothing in between: only triangles tell.
  Mesh mesh = test::jittered_soup(test::icosphere(3), 0);
  test::append(mesh, test::jittered_soup(times(test::icosphere(2), 1e-6), 0));
  CHECK(distance_in(mesh) == 0);
  test::append(mesh, times(test::icosphere(2), 3e-6));
  CHECK(distance_in(mesh) == 0);
}

TEST_CASE("NearMisses: a mesh with a vertex far away has none, and is looked at in no time") {
  Mesh mesh = test::jittered_soup(test::icosphere(6), 1e-7);
  CHECK(distance_in(mesh) > 0);
  mesh.positions.push_back({1e9, 0, 0});
  CHECK(distance_in(mesh) == 0);
  mesh = test::icosphere(5);
  mesh.positions.push_back({1e7, 0, 0});
  CHECK(distance_in(mesh) == 0);
}

TEST_CASE("NearMisses: distances of all sizes are no misses") {
  Mesh mesh;
  double size = 1;
  for (int i = 0; i < 40; ++i, size *= 0.7) {
    test::append(mesh, test::jittered_soup(times(test::octahedron(), size), 0.05 * size));
  }
  CHECK(distance_in(mesh) == 0);
}
