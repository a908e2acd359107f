// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <span>

#include <doctest/doctest.h>

#include "geometry/simplify/orient.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// Turns over about `per_cent` per cent of the triangles, and returns how many.
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

/// A strip of quadrilaterals, closed after half a turn.
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

TEST_CASE("orient: what most of a piece's area faces is what all face") {
  const Mesh in_order = sphere(5);
  for (const std::uint32_t per_cent : {0U, 1U, 5U, 40U}) {
    CAPTURE(per_cent);
    Random random(per_cent + 1);
    Mesh mesh = in_order;
    const std::uint64_t turned = turn_some(mesh.triangles, per_cent, random);
    CHECK(orient(mesh) == turned);
    CHECK(mesh.triangles == in_order.triangles);
    CHECK(orient(mesh) == 0);
  }
}

TEST_CASE("orient: the majority wins even if it is wrong") {
  const Mesh in_order = sphere(5);
  for (const std::uint32_t per_cent : {60U, 99U}) {
    CAPTURE(per_cent);
    Random random(per_cent);
    Mesh mesh = in_order;
    const std::uint64_t turned = turn_some(mesh.triangles, per_cent, random);
    CHECK(orient(mesh) == mesh.triangles.size() - turned);
    CHECK(mesh.triangles == all_turned(in_order.triangles));
  }
}

TEST_CASE("orient: many small triangles do not turn a few that are large") {
  Mesh mesh = flat_grid(8, 8);
  for (Vec3& p : mesh.positions)
    p.x = p.x < 0.8 ? p.x * 1e-3 : p.x;  // two of eight columns are wide
  std::vector<Triangle> in_order = mesh.triangles;
  const auto is_wide = [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(),
                       [&](std::uint32_t v) { return mesh.positions[v].x > 0.01; });
  };
  std::uint64_t turned = 0;
  for (Triangle& t : mesh.triangles) {
    if (is_wide(t)) continue;
    std::swap(t[1], t[2]);
    ++turned;
  }
  REQUIRE(2 * turned > mesh.triangles.size());
  CHECK(orient(mesh) == turned);
  CHECK(mesh.triangles == in_order);
}

TEST_CASE("orient: where there is no area the triangles are counted") {
  Mesh mesh = sphere(3);
  for (Vec3& p : mesh.positions) p = {};
  const std::vector<Triangle> in_order = mesh.triangles;
  Random random(7);
  CHECK(orient(mesh) == 0);
  const std::uint64_t turned = turn_some(mesh.triangles, 30, random);
  CHECK(orient(mesh) == turned);
  CHECK(mesh.triangles == in_order);
}

TEST_CASE("orient: each piece by itself") {
  const Mesh one = sphere(3);
  Mesh mesh = one;
  append(mesh, one, {4, 0, 0});
  append(mesh, flat_grid(7, 5), {0, 4, 0});
  const std::vector<Triangle> in_order = mesh.triangles;
  const std::size_t size = one.triangles.size();
  Random random(3);
  const std::span<Triangle> all(mesh.triangles);
  const std::uint64_t first = turn_some(all.first(size), 10, random);
  const std::uint64_t second = turn_some(all.subspan(size, size), 80, random);
  CHECK(orient(mesh) == first + size - second);
  const std::vector<Triangle> other = all_turned(in_order);
  for (std::size_t t = 0; t < in_order.size(); ++t) {
    const bool is_second = t >= size && t < 2 * size;
    REQUIRE(mesh.triangles[t] == (is_second ? other[t] : in_order[t]));
  }
}

TEST_CASE("orient: across edges of more than two triangles nothing is said") {
  Mesh wings = {.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                .triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  const std::vector<Triangle> before = wings.triangles;
  CHECK(orient(wings) == 0);
  CHECK(wings.triangles == before);
}

TEST_CASE("orient: a Moebius strip keeps a seam") {
  for (const std::uint32_t segments : {5U, 80U}) {
    Mesh mesh = moebius_strip(segments, 3);
    REQUIRE(check(mesh).euler == 0);
    Random random(segments);
    turn_some(mesh.triangles, 50, random);
    REQUIRE(check(mesh).crowded_edges > 4);
    orient(mesh);
    const Validity after = check(mesh);
    CHECK(after.crowded_edges >= 1);
    CHECK(after.crowded_edges <= 7);  // once across
    CHECK(after.degenerate + after.duplicate == 0);
    CHECK(after.euler == 0);
    CHECK(after.components == 1);
  }
}
