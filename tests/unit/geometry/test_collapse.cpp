// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "collapse_bench.hpp"
#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/vertex_flags.hpp"
#include "support/meshes.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

constexpr CollapseLimits k_any{UINT64_MAX, HUGE_VAL};

Collapse judged(CollapseBench& bench, std::uint32_t a, std::uint32_t b,
                const CollapseLimits& limits = k_any) {
  CollapseJudge judge(bench.state());
  return judge.judge(a, b, limits);
}

/// Vertex v of the grid's column c and row r.
constexpr std::uint32_t k_side = 6;
constexpr std::uint32_t at(std::uint32_t c, std::uint32_t r) {
  return r * (k_side + 1) + c;
}

/// Two flat faces that meet at a right angle, where x is a half.
Mesh roof() {
  return grid(k_side, k_side, [](double x, double) { return 0.5 - std::abs(x - 0.5); });
}

/// Only the two triangles at edge 0-1: a bow tie's middle.
Mesh two_triangles() {
  return {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
}

/// Two three-sided tubes that share the ring 0-1-2; there is no triangle between 0, 1 and 2.
Mesh waist() {
  Mesh mesh = {{{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}}, {}};
  for (const double z : {2.0, -2.0}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 3; ++i) {
      mesh.positions.push_back(mesh.positions[i] * 1.5 + Vec3{0, 0, z});
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t k = (i + 1) % 3;
      std::vector<Triangle> sides = {{i, k, first + k}, {i, first + k, first + i}};
      for (const Triangle& t : sides) {
        mesh.triangles.push_back(z > 0 ? t : Triangle{t[0], t[2], t[1]});
      }
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("a collapse on a plane costs nothing and takes two triangles") {
  CollapseBench bench(flat_grid(k_side, k_side));
  const Collapse made = judged(bench, at(2, 2), at(3, 2));
  CHECK(made.triangles == 2);
  CHECK(made.cost == 0);
  CHECK(made.position.z == 0);
  CHECK(made.position.y == doctest::Approx(2.0 / k_side));
}

TEST_CASE("a border vertex goes along the border and takes one triangle") {
  CollapseBench bench(flat_grid(k_side, k_side));
  const Collapse along = judged(bench, at(2, 0), at(3, 0));
  CHECK(along.triangles == 1);
  CHECK(along.cost == 0);
  CHECK(along.position.y == 0);
  // A vertex from inside is drawn to the border, which stays as it is.
  const Collapse inwards = judged(bench, at(2, 0), at(2, 1));
  CHECK(inwards.triangles == 2);
  CHECK(inwards.position == bench.mesh.positions[at(2, 0)]);
}

TEST_CASE("a collapse is bounded by what it may cost and by what it may remove") {
  CollapseBench bench(wavy_grid(k_side, k_side));
  const Collapse made = judged(bench, at(2, 2), at(3, 3));
  REQUIRE(made.triangles == 2);
  REQUIRE(made.cost > 0);
  CHECK(judged(bench, at(2, 2), at(3, 3), {2, made.cost}).triangles == 2);
  CHECK(judged(bench, at(2, 2), at(3, 3), {1, HUGE_VAL}).triangles == 0);
  CHECK(judged(bench, at(2, 2), at(3, 3), {2, made.cost * 0.999}).triangles == 0);
}

TEST_CASE("what would pinch a surface is refused for its topology") {
  // The ends of edge 0-1 have a common neighbour, 2, but 0-1-2 is no triangle.
  CollapseBench bench(waist());
  const Collapse pinched = judged(bench, 0, 1);
  CHECK(pinched.triangles == 0);
  CHECK(pinched.by_topology);
  // Two triangles would vanish, and a tetrahedron would become two triangles back to back.
  CollapseBench pair(two_triangles());
  CHECK(judged(pair, 0, 1).by_topology);
  CollapseBench closed(test::tetrahedron());
  CHECK(judged(closed, 0, 1).by_topology);
  // Across a strip, from border to border.
  CollapseBench strip(flat_grid(4, 1));
  CHECK(judged(strip, 2, 7).by_topology);
  CHECK(judged(strip, 1, 2).triangles == 1);
}

TEST_CASE("a collapse that would turn a triangle over is refused") {
  // A flat fan round 0 whose rim has a deep notch at 6: 1 does not see all of it.
  Mesh fan = {
      {{0, 0, 0}, {4, 0, 0}, {2, 3, 0}, {-2, 3, 0}, {-4, 0, 0}, {-2, -3, 0}, {0.2, -0.4, 0}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 1}}};
  CollapseBench bench(fan);
  const Collapse made = judged(bench, 0, 5);
  const bool to_rim = made.triangles > 0 && made.position == fan.positions[5];
  CHECK(!to_rim);
  CHECK(!made.by_topology);
  // Without the notch the collapse is allowed.
  fan.positions[6] = {2, -3, 0};
  CollapseBench round(fan);
  CHECK(judged(round, 0, 5).position == fan.positions[5]);
}

TEST_CASE("a hub of many triangles is left alone, its rim is not") {
  constexpr std::uint32_t k_rim = 400;
  Mesh hub = {{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < k_rim; ++i) {
    const double turn = 2 * std::acos(-1.0) * i / k_rim;
    hub.positions.push_back({std::cos(turn), std::sin(turn), 0});
    hub.triangles.push_back({0, 1 + i, 1 + (i + 1) % k_rim});
  }
  CollapseBench bench(hub);
  CHECK(judged(bench, 0, 1).triangles == 0);
  CHECK(judged(bench, 5, 6).triangles == 1);
}

TEST_CASE("on a crease a vertex moves along it, and from beside it merges into it") {
  CollapseBench bench(roof(), 40);
  constexpr std::uint32_t k_middle = k_side / 2;
  REQUIRE((bench.flags[at(k_middle, 2)] & k_crease) != 0);
  const Collapse along = judged(bench, at(k_middle, 2), at(k_middle, 3));
  CHECK(along.triangles == 2);
  CHECK(along.position.x == doctest::Approx(0.5));
  CHECK(along.position.z == doctest::Approx(0.5));
  CHECK(along.cost < 1e-12);
  const Collapse beside = judged(bench, at(k_middle, 2), at(k_middle - 1, 2));
  CHECK(beside.position == bench.mesh.positions[at(k_middle, 2)]);
}

TEST_CASE("positions are rounded to the mesh's type before they are judged") {
  CollapseBench bench(wavy_grid(k_side, k_side));
  CollapseState state = bench.state();
  state.type = PositionType::float32;
  CollapseJudge judge(state);
  const Collapse made = judge.judge(at(2, 2), at(3, 3), k_any);
  REQUIRE(made.triangles == 2);
  for (const double x : {made.position.x, made.position.y, made.position.z}) {
    CHECK(x == static_cast<double>(static_cast<float>(x)));
  }
}

TEST_CASE("neighbours that have merged in the same pass are seen where they are now") {
  CollapseBench bench(flat_grid(k_side, k_side));
  // (4,2) has become (4,3): of the two triangles between (3,2), (4,2), (4,3) one is gone.
  bench.target[at(4, 2)] = at(4, 3);
  const Collapse made = judged(bench, at(2, 2), at(3, 2));
  CHECK(made.triangles == 2);
  CHECK(made.cost == 0);
}
