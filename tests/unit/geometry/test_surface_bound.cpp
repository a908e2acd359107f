// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

constexpr double k_tolerance = 1.1;

Mesh simplified_to_bound(const Mesh& mesh, double distance, SimplifyOptions options = {}) {
  const SurfaceBound bound(mesh, {.distance = distance});
  options.bound = &bound;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({});
  return simplifier.mesh();
}

/// The greatest distance in both directions, vertices included.
double farthest(const Mesh& x, const Mesh& y) {
  const auto from_to = [](const Mesh& from, const Mesh& to) {
    return std::max(measure_distance(from, to, {200'000, 1}).max,
                    DistanceMeter(to, 1).measure(from.positions).max);
  };
  return std::max(from_to(x, y), from_to(y, x));
}

/// A wave of long sides, and one needle of a single vertex.
Mesh sheet_with_a_needle() {
  Mesh mesh = test::grid(80, 80);
  for (Vec3& p : mesh.positions) p.z = 2 * std::sin(p.x * 0.1);
  mesh.positions[40 * 81 + 40].z += 3;
  return mesh;
}

/// Flat, with a slot from one side to the middle: a triangle across it has its vertices on the
/// sheet.
Mesh sheet_with_a_slot(double width) {
  Mesh mesh = test::grid(60, 60);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      const Vec3 p = mesh.positions[v];
      return p.x >= 30 && p.x <= 30 + width && p.y >= 30;
    });
  });
  // Drops the vertices that no triangle uses.
  return Simplifier(mesh, {}).mesh();
}

/// Terraces: all is flat, except a triangle from one to the next.
Mesh terraces() {
  Mesh mesh = test::grid(64, 64);
  for (Vec3& p : mesh.positions) {
    p.z = 4 * std::floor(p.x / 16);
    p.x += p.x == 16 || p.x == 32 || p.x == 48 ? -0.95 : 0;
  }
  return mesh;
}

/// Rough, with sides many times longer than the bounds that are tried.
Mesh jagged_ridges() {
  Mesh mesh = test::grid(60, 60);
  for (Vec3& p : mesh.positions) {
    p.z = 0.5 * std::sin(p.x * 2.9 + p.y) + 0.5 * std::cos(p.y * 2.3 - p.x * 0.7);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a bound is kept in both directions, and the rest is simplified as far as it goes") {
  const Mesh mesh = sheet_with_a_needle();
  for (const double bound : {0.05, 0.5}) {
    const Mesh result = simplified_to_bound(mesh, bound);
    CHECK(farthest(mesh, result) <= k_tolerance * bound);
    CHECK(result.triangles.size() < mesh.triangles.size() / 20);
    CHECK(measure_topology(result).euler == 1);
  }
}

TEST_CASE("what is flat does not span slots or steps that are wider than the bound") {
  for (const Mesh& mesh : {sheet_with_a_slot(6), terraces()}) {
    const Mesh result = simplified_to_bound(mesh, 1);
    CHECK(farthest(mesh, result) <= k_tolerance);
    CHECK(result.triangles.size() < 150);
  }
}

TEST_CASE("between long sides of the surface the bound is kept, too") {
  const Mesh mesh = jagged_ridges();
  for (const double bound : {0.15, 0.2, 0.3}) {
    const Mesh result = simplified_to_bound(mesh, bound);
    CHECK(farthest(mesh, result) <= k_tolerance * bound);
    CHECK(result.triangles.size() < mesh.triangles.size() * 19 / 20);
  }
}

TEST_CASE("a wider bound needs fewer triangles") {
  const Mesh mesh = test::torus(140, 70);
  std::size_t before = mesh.triangles.size();
  for (const double bound : {0.002, 0.01, 0.05}) {
    const Mesh result = simplified_to_bound(mesh, bound);
    CHECK(farthest(mesh, result) <= k_tolerance * bound);
    CHECK(farthest(mesh, result) > bound / 2);
    CHECK(result.triangles.size() < before / 3);
    before = result.triangles.size();
  }
}

TEST_CASE("where handles may go, they go within the bound") {
  const Mesh mesh = test::torus(100, 50);
  const Mesh result =
      simplified_to_bound(mesh, 0.05, {.lines = {.topology = TopologyMode::simplify}});
  CHECK(farthest(mesh, result) <= k_tolerance * 0.05);
  CHECK(measure_topology(result).nonmanifold_edges == 0);
}

TEST_CASE("locked vertices stay, and a bound on another surface is one on that") {
  const Mesh mesh = sheet_with_a_needle();
  const Mesh result = simplified_to_bound(mesh, 0.05, {.locked_vertices = 100});
  for (std::size_t v = 0; v < 100; ++v) REQUIRE(result.positions[v] == mesh.positions[v]);
  Mesh lower = mesh;
  for (Vec3& p : lower.positions) p.z -= 0.2;
  const SurfaceBound bound(lower, {.distance = 0.3, .is_used_up = true});
  Simplifier simplifier(mesh, {.bound = &bound});
  simplifier.reduce({});
  CHECK(farthest(lower, simplifier.mesh()) <= k_tolerance * 0.3);
  CHECK(simplifier.triangles() < mesh.triangles.size() / 10);
}

TEST_CASE("a surface of a bound knows how far a point is, and what stands for it") {
  const SurfaceBound bound(test::icosphere(3), {.distance = 0.1});
  std::uint32_t guess = 0;
  CHECK(std::isinf(bound.squared_distance_near({0, 0, 1.5}, 0, guess)));
  CHECK(std::sqrt(bound.squared_distance_near({0, 0, 1.09}, 0, guess)) ==
        doctest::Approx(0.09).epsilon(0.05));
  CHECK(bound.squared_distance_near({0, 0, 1.05}, 0.01, guess) <= 0.01);
  CHECK(bound.points().size() >= 642);
  // Of two triangles the vertices alone tell little: points inside, and five sides.
  const SurfaceBound of_two(test::grid(1, 1), {.distance = 0.1});
  CHECK(of_two.points().size() == 4 + 2 * 3 * 3);
  std::size_t sides = 0;
  for (std::uint32_t i = 0; i < of_two.points().size(); ++i) sides += of_two.across_sides(i).size();
  CHECK(sides == 2 * 5);
  CHECK(SurfaceBound(test::grid(1, 1), {.distance = 1}).across_sides(0).empty());
}
