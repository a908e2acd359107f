// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <span>

#include <doctest/doctest.h>

#include "geometry/simplify/orient.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// Turns about so many per cent of the triangles, and returns how many.
std::uint64_t turn_some(std::span<Triangle> triangles, std::uint32_t per_cent, Random& random) {
  std::uint64_t turned = 0;
  for (Triangle& t : triangles) {
    if (random.below(100) >= per_cent) continue;
    std::swap(t[1], t[2]);
    ++turned;
  }
  return turned;
}

std::vector<Triangle> all_turned(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return triangles;
}

/// A strip of quadrilaterals that is closed after half a turn.
Mesh moebius_strip(std::uint32_t segments, std::uint32_t across) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double angle = 2 * std::numbers::pi * i / segments;
    for (std::uint32_t k = 0; k <= across; ++k) {
      const double w = 0.6 * k / across - 0.3;
      const double r = 1 + w * std::cos(angle / 2);
      mesh.positions.push_back({r * std::cos(angle), r * std::sin(angle), w * std::sin(angle / 2)});
    }
  }
  const std::uint32_t row = across + 1;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const bool last = i + 1 == segments;
    for (std::uint32_t k = 0; k < across; ++k) {
      const std::uint32_t a = i * row + k;
      const std::uint32_t b = a + 1;
      const std::uint32_t c = last ? across - k : a + row;
      const std::uint32_t d = last ? across - k - 1 : b + row;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("orient: what most triangles of a piece face is what all face") {
  const std::vector<Triangle> in_order = sphere(5).triangles;
  for (const std::uint32_t per_cent : {0U, 1U, 5U, 40U}) {
    CAPTURE(per_cent);
    Random random(per_cent + 1);
    std::vector<Triangle> triangles = in_order;
    const std::uint64_t turned = turn_some(triangles, per_cent, random);
    CHECK(orient(triangles) == turned);
    CHECK(triangles == in_order);
    CHECK(orient(triangles) == 0);
  }
}

TEST_CASE("orient: the majority wins even if it is wrong") {
  const std::vector<Triangle> in_order = sphere(5).triangles;
  for (const std::uint32_t per_cent : {50U, 60U, 99U}) {
    CAPTURE(per_cent);
    Random random(per_cent);
    std::vector<Triangle> triangles = in_order;
    const std::uint64_t turned = turn_some(triangles, per_cent, random);
    const bool most = 2 * turned > triangles.size();
    CHECK(orient(triangles) == (most ? triangles.size() - turned : turned));
    CHECK(triangles == (most ? all_turned(in_order) : in_order));
  }
}

TEST_CASE("orient: each piece by itself") {
  const Mesh one = sphere(3);
  Mesh mesh = one;
  append(mesh, one, {4, 0, 0});
  append(mesh, flat_grid(7, 5), {0, 4, 0});
  std::vector<Triangle> triangles = mesh.triangles;
  const std::size_t size = one.triangles.size();
  Random random(3);
  const std::span<Triangle> all(triangles);
  const std::uint64_t first = turn_some(all.first(size), 10, random);
  const std::uint64_t second = turn_some(all.subspan(size, size), 80, random);
  CHECK(orient(triangles) == first + size - second);
  const std::vector<Triangle> other = all_turned(mesh.triangles);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const bool is_second = t >= size && t < 2 * size;
    REQUIRE(triangles[t] == (is_second ? other[t] : mesh.triangles[t]));
  }
}

TEST_CASE("orient: across edges of more than two triangles nothing is said") {
  std::vector<Triangle> wings{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const std::vector<Triangle> before = wings;
  CHECK(orient(wings) == 0);
  CHECK(wings == before);
}

TEST_CASE("orient: a Moebius strip keeps a seam") {
  for (const std::uint32_t segments : {5U, 80U}) {
    Mesh mesh = moebius_strip(segments, 3);
    REQUIRE(check(mesh).euler == 0);
    Random random(segments);
    turn_some(mesh.triangles, 50, random);
    REQUIRE(check(mesh).crowded_edges > 4);
    orient(mesh.triangles);
    const Validity after = check(mesh);
    CHECK(after.crowded_edges >= 1);
    CHECK(after.crowded_edges <= 7);  // once across
    CHECK(after.degenerate + after.duplicate == 0);
    CHECK(after.euler == 0);
    CHECK(after.components == 1);
  }
}
