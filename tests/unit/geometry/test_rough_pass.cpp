// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "collapse_bench.hpp"
#include "geometry/simplify/rough_pass.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

struct RoughBench : CollapseBench {
  using CollapseBench::CollapseBench;
  RoughPartners partners() { return {state(), touched}; }
};

// A square sheet with smooth waves in one corner, an eighth of the side wide.
constexpr std::uint32_t k_rough_side = 160;
bool in_corner(Vec3 p) {
  return p.x < k_rough_side / 8.0 && p.y < k_rough_side / 8.0;
}
Mesh sheet_with_detail() {
  Mesh mesh = flat_grid(k_rough_side, k_rough_side);
  for (Vec3& p : mesh.positions) {
    p = p * static_cast<double>(k_rough_side);
    if (in_corner(p)) p.z = std::sin(p.x) * std::cos(0.7 * p.y);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a rough pass merges a vertex with its nearest neighbour that may") {
  // A fan of six vertices round vertex 0, all at different distances.
  Mesh mesh{{{0, 0, 0}, {5, 0, 0}, {2, 3, 0}, {-2, 2, 0}, {-4, 0, 0}, {-2, -4, 0}, {3, -3, 0}},
            {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 1}}};
  RoughBench bench(mesh);
  CHECK(bench.partners().of(0) == 3);
  bench.touched[3] = 1;
  CHECK(bench.partners().of(0) == 2);
  bench.flags[2] |= k_fixed;
  CHECK(bench.partners().of(0) == 4);
  // A vertex that has moved counts where it is now.
  bench.mesh.positions[5] = {0, -1, 0};
  CHECK(bench.partners().of(0) == 5);
  bench.flags[0] |= k_fixed;
  CHECK(bench.partners().of(0) == 0);
}

TEST_CASE("a rough pass takes border vertices along the border or from inside") {
  RoughBench bench(flat_grid(4, 4));
  for (std::uint32_t v = 0; v < bench.mesh.positions.size(); ++v) {
    const std::uint32_t other = bench.partners().of(v);
    REQUIRE(other != v);
    const bool both = (bench.flags[v] & bench.flags[other] & k_border) != 0;
    if (!both) continue;
    const Vec3 middle = (bench.mesh.positions[v] + bench.mesh.positions[other]) * 0.5;
    CHECK((middle.x == 0 || middle.x == 1 || middle.y == 0 || middle.y == 1));
  }
}

TEST_CASE("the limit of a rough pass grows with its share") {
  RoughBench bench(wavy_grid(160, 160));
  CollapseJudge judge(bench.state());
  const auto limit = [&](double share, double most = HUGE_VAL) {
    return bench.partners().estimate_limit(judge, share, most);
  };
  REQUIRE(limit(0.5).has_value());
  REQUIRE(limit(0.995).has_value());
  CHECK(*limit(0.5) > 0);
  CHECK(*limit(0.995) > *limit(0.5));
  CHECK(*limit(1) > *limit(0.995));
  CHECK(limit(1, *limit(0.995)) == limit(0.995));
  CHECK(!limit(1, -1).has_value());
  std::fill(bench.touched.begin(), bench.touched.end(), std::uint8_t{1});
  CHECK(!limit(0.5).has_value());
}

TEST_CASE("a rough pass takes nothing that is far dearer than half of what it takes") {
  // Where more than half is flat, only flat places are taken.
  RoughBench sheet(sheet_with_detail());
  CollapseJudge judge(sheet.state());
  for (const double share : {0.5, 0.97, 0.995, 1.0}) {
    CHECK(sheet.partners().estimate_limit(judge, share, HUGE_VAL) == 0);
  }
  // One vertex in thirteen belongs to spheres far larger than the first one.
  Mesh mesh = sphere(6);
  for (Vec3& p : mesh.positions) p = p * 0.01;
  const Mesh large = sphere(2);
  for (int i = 1; i <= 20; ++i) append(mesh, large, {3.0 * i, 0, 0});
  RoughBench bench(mesh);
  CollapseJudge judge_all(bench.state());
  const auto limit = [&](double share) {
    return bench.partners().estimate_limit(judge_all, share, HUGE_VAL).value();
  };
  CHECK(limit(0.48) > 0);
  CHECK(limit(0.9) < 1000 * limit(0.48));
  CHECK(limit(0.96) <= 65'536 * limit(0.48));
}

TEST_CASE("a surface that wants long triangles gets no rough pass") {
  const auto has_limit = [](const Mesh& mesh) {
    RoughBench bench(mesh);
    CollapseJudge judge(bench.state());
    return bench.partners().estimate_limit(judge, 0.97, HUGE_VAL).has_value();
  };
  CHECK(has_limit(sphere(6)));
  CHECK(has_limit(sheet_with_detail()));
  CHECK_FALSE(has_limit(wide_torus(200, 100)));
  CHECK_FALSE(has_limit(ring_of_tube(1000, 40, 0.04)));
  // The same beside balls, where every collapse is expensive.
  Mesh mesh = ring_of_tube(1000, 40, 0.04);
  for (Vec3& p : mesh.positions) p = p * 0.3;
  const Mesh ball = sphere(5);
  for (int i = 1; i <= 3; ++i) append(mesh, ball, {3.0 * i, 0, 0});
  CHECK_FALSE(has_limit(mesh));
}

TEST_CASE("thin tubes keep their shape however far the goal is") {
  const Mesh mesh = ring_of_tube(3000, 24, 0.02);
  Simplifier simplifier(mesh, {});
  simplifier.reduce({.triangles = mesh.triangles.size() / 50});
  CHECK(measure_distance(mesh, simplifier.mesh(), {.samples = 50'000}).rms < 4e-4);
}

TEST_CASE("what was simplified before gets no rough pass") {
  const Mesh mesh = sphere(6);
  const std::uint64_t goal = 700;
  Simplifier ranked(mesh, {.was_simplified = true});
  Simplifier rough(mesh, {});
  ranked.reduce({.triangles = goal});
  rough.reduce({.triangles = goal});
  CHECK(ranked.triangles() == goal);
  CHECK_FALSE(same_bytes(ranked.mesh(), rough.mesh()));
}

TEST_CASE("rough passes leave the detail of a flat sheet alone") {
  const Mesh mesh = sheet_with_detail();
  Simplifier simplifier(mesh, {});
  simplifier.reduce({mesh.triangles.size() / 50});
  CHECK(simplifier.triangles() <= mesh.triangles.size() / 50);
  const Mesh& result = simplifier.mesh();
  CHECK(is_clean(result));
  const auto kept = std::count_if(result.positions.begin(), result.positions.end(), in_corner);
  CHECK(kept > 300);  // of 400
  CHECK(measure_distance(mesh, result, {.samples = 100'000}).max < 0.2);
}

TEST_CASE("a goal with more to follow is met as exactly") {
  Simplifier simplifier(sphere(6), {});
  simplifier.reduce({.triangles = 10'000, .last_triangles = 1000});
  CHECK(simplifier.triangles() == 10'000);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(simplifier.pass_cost() > 0);
  simplifier.reduce({1000});
  CHECK(simplifier.triangles() == 1000);
}

TEST_CASE("no triangle of a height field turns over") {
  const Mesh mesh = grid(250, 250, [](double x, double y) {
    return 0.01 * std::sin(40 * x) * std::cos(50 * y) + 0.0005 * std::sin(900 * x + 1300 * y);
  });
  for (const double share : {0.2, 0.05, 0.01}) {
    CAPTURE(share);
    Simplifier simplifier(mesh, {});
    simplifier.reduce(
        {static_cast<std::uint64_t>(share * static_cast<double>(mesh.triangles.size()))});
    const Mesh& result = simplifier.mesh();
    const auto turned =
        std::count_if(result.triangles.begin(), result.triangles.end(), [&](const Triangle& t) {
          const Vec3 a = result.positions[t[0]];
          const Vec3 n = cross(result.positions[t[1]] - a, result.positions[t[2]] - a);
          return n.z < -0.05 * length(n);  // a sliver may stand on its edge
        });
    CHECK(turned == 0);
  }
}
