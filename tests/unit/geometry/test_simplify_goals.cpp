// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "support/meshes.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;

TEST_CASE("a short last step does not give up a topology that was kept so far") {
  // Removing a speck is always cheaper than the sphere's next collapse.
  constexpr int k_specks = 60;
  Mesh mesh = test::icosphere(4);
  for (int i = 0; i < k_specks; ++i) {
    Mesh speck = test::tetrahedron();
    for (Vec3& p : speck.positions) p = p * 1e-4 + Vec3{2, 0.1 * i, 0};
    test::append(mesh, speck);
  }
  Simplifier simplifier(mesh, {});
  for (const std::uint64_t goal : {2240U, 2236U, 2232U}) {
    CAPTURE(goal);
    simplifier.reduce({.triangles = goal});
    CHECK(simplifier.triangles() == goal);
    CHECK_FALSE(simplifier.simplifies_topology());
    CHECK(measure_topology(simplifier.mesh()).components == k_specks + 1);
  }
  // They go where nothing else is left.
  simplifier.reduce({.triangles = 100});
  CHECK(simplifier.triangles() == 100);
  CHECK(simplifier.simplifies_topology());
}

TEST_CASE("what is kept on the way is the mesh as it was, and changes no result") {
  const Mesh mesh = test::torus(60, 40);
  Simplifier plain(mesh, {});
  plain.reduce({.triangles = 400});
  Simplifier keeping(mesh, {});
  SimplifyGoal goal{.triangles = 400};
  goal.keep_at = {9000, 781, 625, 500};
  keeping.reduce(goal);
  CHECK(keeping.mesh().positions == plain.mesh().positions);
  CHECK(keeping.mesh().triangles == plain.mesh().triangles);
  const std::vector<Mesh> kept = keeping.take_kept();
  REQUIRE(kept.size() == 2);  // the earlier ones are too far away by now
  CHECK(kept[0].triangles.size() == 624);
  CHECK(kept[1].triangles.size() == 500);
  CHECK(measure_topology(kept[1]).euler == 0);
}

TEST_CASE("a cost that leaves little to do is no reason to go on in order") {
  Simplifier smooth(test::torus(400, 400), {});
  smooth.reduce({.triangles = 110'000, .last_triangles = 1000});
  const double reached = smooth.pass_cost();
  const auto left = [&] { return static_cast<double>(smooth.triangles()); };
  const double before = left();
  smooth.reduce({.triangles = 1000, .max_cost = 0.9 * reached});
  CHECK(left() > 0.95 * before);
  CHECK_FALSE(smooth.is_slowed_by_topology());
  smooth.reduce({.triangles = 1000, .max_cost = 4 * reached});
  CHECK(left() < 0.9 * before);
  CHECK_FALSE(smooth.is_slowed_by_topology());
  smooth.reduce({.triangles = 1000});  // the last collapses go in order
  CHECK(smooth.triangles() == 1000);
  CHECK(smooth.is_slowed_by_topology());
}

TEST_CASE("a goal that is met by one triangle at the border leaves more to do") {
  const Mesh mesh = simplify_test::wavy_grid(120, 120);
  for (std::uint64_t goal = 3000; goal < 3008; ++goal) {
    CAPTURE(goal);
    Simplifier simplifier(mesh, {});
    simplifier.reduce({.triangles = goal, .last_triangles = 500});
    CHECK(simplifier.triangles() == goal);
    simplifier.reduce({.triangles = 500});
    CHECK(simplifier.triangles() == 500);
  }
}

TEST_CASE("no corner of coarse ground goes for the last triangle of fine models") {
  Mesh mesh = simplify_test::wavy_grid(12, 12);
  const std::size_t ground = mesh.triangles.size();
  for (int i = 0; i < 3; ++i) {
    Mesh ball = test::icosphere(5);
    for (Vec3& p : ball.positions) p = p * 1e-3 + Vec3{0.3 * i, 0.3, 2};
    test::append(mesh, ball);
  }
  const auto on_ground = [](const Mesh& made) {
    return std::count_if(made.triangles.begin(), made.triangles.end(),
                         [&](const Triangle& t) { return made.positions[t[0]].z < 1; });
  };
  for (const std::uint64_t odd : {15'001U, 15'003U}) {
    CAPTURE(odd);
    Simplifier in_passes(mesh, {});
    in_passes.reduce({.triangles = odd, .last_triangles = 1000});
    CHECK(in_passes.triangles() == odd + 1);
    CHECK(on_ground(in_passes.mesh()) == ground);
    Simplifier in_order(mesh, {});
    in_order.reduce({.triangles = odd});
    CHECK(in_order.triangles() == odd - 1);
    CHECK(on_ground(in_order.mesh()) == ground);
  }
}

TEST_CASE("edges round thin tubes that are refused are no reason to stop") {
  Mesh rings;
  constexpr int k_rings = 40;
  for (int i = 0; i < k_rings; ++i) {
    Mesh ring = simplify_test::ring_of_tube(200, 10, 0.05);
    simplify_test::append(rings, ring, {0, 0, 1.0 * i});
  }
  Simplifier simplifier(rings, {.lines = {.topology = TopologyMode::keep_while_fair}});
  simplifier.reduce({.triangles = 72 * k_rings});
  CHECK(simplifier.triangles() == 72 * k_rings);
  CHECK_FALSE(simplifier.is_held_by_topology());
  CHECK(measure_topology(simplifier.mesh()).components == k_rings);
  CHECK(measure_topology(simplifier.mesh()).euler == 0);
}

TEST_CASE("a goal for passes that is met changes nothing") {
  Mesh torus = test::torus(120, 80);
  Simplifier plain(torus, {.lines = {.topology = TopologyMode::keep_while_fair}});
  Simplifier stopped(torus, {.lines = {.topology = TopologyMode::keep_while_fair}});
  plain.reduce({.triangles = 4'000, .last_triangles = 200});
  stopped.reduce({.triangles = 4'000, .last_triangles = 200, .in_passes = true});
  CHECK(stopped.triangles() <= 4'000);
  for (Simplifier* each : {&plain, &stopped}) each->reduce({.triangles = 500});
  CHECK(plain.mesh().positions == stopped.mesh().positions);
  CHECK(plain.mesh().triangles == stopped.mesh().triangles);
}

TEST_CASE("it is told where the topology refuses much") {
  Mesh specks;
  for (int i = 0; i < 2000; ++i) {
    Mesh speck = test::octahedron();
    for (Vec3& p : speck.positions) p = p + Vec3{3.0 * i, 0, 0};
    test::append(specks, speck);
  }
  Simplifier simplifier(specks, {.lines = {.topology = TopologyMode::keep_while_fair}});
  CHECK_FALSE(simplifier.is_slowed_by_topology());
  simplifier.reduce({.triangles = 9000, .last_triangles = 100});
  CHECK(simplifier.is_slowed_by_topology());
}

TEST_CASE("a large piece does not give up a corner for the last two triangles") {
  constexpr std::uint32_t k_specks = 30;
  Mesh mesh = test::box({10, 10, 1});
  for (std::uint32_t i = 0; i < k_specks; ++i) {
    Mesh speck = test::tetrahedron();
    for (Vec3& p : speck.positions) p = p * (0.1 + 0.001 * i);
    simplify_test::append(mesh, speck, {0.4 + 0.3 * i, 5, 1.5});
  }
  const std::uint64_t all = mesh.triangles.size();
  for (const std::uint64_t fewer : {3U, 4U}) {
    CAPTURE(fewer);
    Simplifier simplifier(mesh, {.lines = {.topology = TopologyMode::simplify}});
    simplifier.reduce({.triangles = all - fewer});
    CHECK(simplifier.triangles() == all - fewer);
    CHECK(measure_topology(simplifier.mesh()).components == k_specks + 1);
    const std::vector<Vec3>& points = simplifier.mesh().positions;
    CHECK(std::count_if(points.begin(), points.end(), [](Vec3 p) {
            return (p.x == 0 || p.x == 10) && (p.y == 0 || p.y == 10);
          }) == 8);
  }
}

namespace {

/// A cube with `side` cells per side, and all walls between them.
Mesh cells(std::uint32_t side) {
  Mesh mesh;
  const std::uint32_t row = side + 1;
  for (std::uint32_t i = 0; i < row * row * row; ++i) {
    mesh.positions.push_back({1.0 * (i % row), 1.0 * (i / row % row), 1.0 * (i / (row * row))});
  }
  const std::array<std::uint32_t, 3> steps = {1, row, row * row};
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const int other = (axis + 1) % 3;
      if (mesh.positions[v][axis] == side || mesh.positions[v][other] == side) continue;
      const std::uint32_t a = v + steps[static_cast<std::size_t>(axis)];
      const std::uint32_t b = v + steps[static_cast<std::size_t>(other)];
      mesh.triangles.push_back({v, a, a + b - v});
      mesh.triangles.push_back({v, a + b - v, b});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("a block of cells is not drawn back from its sides until little of it is left") {
  const Mesh block = cells(8);
  for (const double ratio : {0.5, 0.2}) {
    CAPTURE(ratio);
    const auto goal =
        static_cast<std::uint64_t>(ratio * static_cast<double>(block.triangles.size()));
    Simplifier simplifier(block, {.lines = {.topology = TopologyMode::simplify}});
    simplifier.reduce({.triangles = goal});
    CHECK(simplifier.triangles() <= goal + 1);
    CHECK(simplifier.triangles() + goal / 1000 + 1 >= goal);
    const Distance lost = measure_distance(block, simplifier.mesh(), {.samples = 20'000});
    CHECK(lost.rms < 0.7);
    CHECK(lost.max < 3.5);
  }
}
