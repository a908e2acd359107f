// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_bound.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::uint64_t count_crossing(const Mesh& mesh) {
  return count_crossing_triangles(mesh, {.threads = 1}).value_or(UINT64_MAX);
}

Mesh reduced_to(const Mesh& mesh, double ratio, CrossingMode mode) {
  SimplifyOptions options{.positions = PositionType::float32};
  options.lines.crossings = mode;
  Simplifier simplifier(mesh, options);
  const auto wanted =
      static_cast<std::uint64_t>(ratio * static_cast<double>(mesh.triangles.size()));
  simplifier.reduce({.triangles = wanted});
  CHECK(simplifier.triangles() <= wanted + 3);
  simplifier.reduce({.triangles = wanted});
  CHECK(simplifier.triangles() <= wanted + 1);
  CHECK(simplifier.triangles() + 2 >= wanted);
  return simplifier.mesh();
}

Mesh two_meshes(Mesh one, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(one.positions.size());
  one.positions.insert(one.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& [a, b, c] : other.triangles) {
    one.triangles.push_back({a + first, b + first, c + first});
  }
  return one;
}

Mesh placed_at(Mesh mesh, double scale, Vec3 by) {
  for (Vec3& p : mesh.positions) p = p * scale + by;
  return mesh;
}

Mesh facing_in(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A wall of two rough sheets that face away from each other.
Mesh rough_wall(double thickness) {
  Mesh front = test::grid(50, 50);
  Mesh back = facing_in(test::grid(50, 50));
  const auto height = [](Vec3 p) { return std::sin(0.11 * p.x) * std::cos(0.13 * p.y) * 4; };
  for (Vec3& p : front.positions) p.z = height(p) + thickness;
  for (Vec3& p : back.positions) p.z = height(p);
  return two_meshes(std::move(front), back);
}

}  // namespace

TEST_CASE("crossings: a shell's sheets stay apart") {
  const Mesh shell = in_memory(*generate_mesh(Shape::shell, 160'000));
  REQUIRE(count_crossing(shell) == 0);
  CHECK(count_crossing(reduced_to(shell, 0.4, CrossingMode::allow)) > 20);
  CHECK(count_crossing(reduced_to(shell, 0.4, CrossingMode::avoid)) == 0);
}

TEST_CASE("crossings: sheets that are nearer than the error stay apart") {
  const Mesh shell = in_memory(*generate_mesh(Shape::shell, 100'000));
  const Mesh some = reduced_to(shell, 0.02, CrossingMode::avoid);
  CHECK(count_crossing(reduced_to(shell, 0.02, CrossingMode::allow)) > 1000);
  CHECK(count_crossing(some) == 0);
  CHECK(measure_topology(some).components == 2);
}

TEST_CASE("crossings: sheets that are nearer than the error meet any count") {
  SimplifyOptions options{.locked_vertices = 4};
  options.lines.crossings = CrossingMode::avoid;
  const Mesh shell = in_memory(*generate_mesh(Shape::shell, 20'000));
  Simplifier simplifier(shell, options);
  for (const std::uint64_t count : {8000U, 2002U, 2000U, 1001U}) {
    for (int turn = 0; turn < 2; ++turn) simplifier.reduce({.triangles = count});
    CHECK(simplifier.triangles() >= count);
    CHECK(simplifier.triangles() <= count + 1);
    CHECK(simplifier.free_triangles() <= simplifier.triangles());
    for (std::size_t v = 0; v < 4; ++v) {
      CHECK(simplifier.mesh().positions[v] == shell.positions[v]);
    }
  }
}

TEST_CASE("crossings: spheres side by side and in each other stay apart") {
  const Mesh ball = test::icosphere(5);
  const Mesh beside = two_meshes(ball, placed_at(ball, 1, {1.9994, 0.06, 0}));
  const Mesh within = two_meshes(ball, facing_in(placed_at(ball, 0.995, {})));
  for (const Mesh& mesh : {beside, within}) {
    REQUIRE(count_crossing(mesh) == 0);
    CHECK(count_crossing(reduced_to(mesh, 0.06, CrossingMode::allow)) > 0);
    CHECK(count_crossing(reduced_to(mesh, 0.06, CrossingMode::avoid)) == 0);
  }
}

TEST_CASE("crossings: the sides of a thin wall stay apart, with a bound on the error, too") {
  const Mesh mesh = rough_wall(0.1);
  REQUIRE(count_crossing(mesh) == 0);
  CHECK(count_crossing(reduced_to(mesh, 0.05, CrossingMode::allow)) > 0);
  CHECK(count_crossing(reduced_to(mesh, 0.05, CrossingMode::avoid)) == 0);

  const SurfaceBound bound(mesh, {0.3, 1});
  for (const CrossingMode mode : {CrossingMode::allow, CrossingMode::avoid}) {
    SimplifyOptions options{.bound = &bound};
    options.lines.crossings = mode;
    Simplifier simplifier(mesh, options);
    simplifier.reduce({});
    CHECK((count_crossing(simplifier.mesh()) == 0) == (mode == CrossingMode::avoid));
  }
}

TEST_CASE("crossings: those of the input lock nothing") {
  const Mesh ball = test::icosphere(5);
  const Mesh mesh = two_meshes(ball, placed_at(ball, 1, {0.7, 0.1, 0}));
  const std::uint64_t before = count_crossing(mesh);
  REQUIRE(before > 0);
  const std::uint64_t after = count_crossing(reduced_to(mesh, 0.02, CrossingMode::avoid));
  CHECK(after > 0);
  CHECK(after < before);
}

TEST_CASE("crossings: what is pinched and cut apart is still looked at") {
  const Mesh mesh = two_meshes(test::torus_with_neck(40, 24),
                               facing_in(placed_at(test::torus_with_neck(40, 24), 0.999, {})));
  SimplifyOptions options;
  options.lines.crossings = CrossingMode::avoid;
  options.lines.topology = TopologyMode::simplify;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({.triangles = 300});
  CHECK(simplifier.triangles() <= 301);
  CHECK(count_crossing(simplifier.mesh()) <= count_crossing(mesh));
}

TEST_CASE("crossings: a thin neck is kept only if it must") {
  const auto gives_way = [](CrossingMode crossings, TopologyMode topology) {
    SimplifyOptions options;
    options.lines.crossings = crossings;
    options.lines.topology = topology;
    Simplifier simplifier(test::torus_with_neck(40, 24), options);
    simplifier.reduce({.triangles = 200});
    CHECK(simplifier.triangles() <= 201);
    return simplifier.simplifies_topology();
  };
  CHECK(gives_way(CrossingMode::avoid, TopologyMode::automatic));
  CHECK(!gives_way(CrossingMode::avoid, TopologyMode::keep));
  CHECK(!gives_way(CrossingMode::allow, TopologyMode::automatic));
}
