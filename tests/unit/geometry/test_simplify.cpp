// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/util/errors.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

double signed_volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    sum += dot(mesh.positions[t[0]], cross(mesh.positions[t[1]], mesh.positions[t[2]]));
  }
  return sum / 6;
}

Mesh reduced_to(Mesh mesh, std::uint64_t triangles) {
  Simplifier simplifier(std::move(mesh), {});
  simplifier.reduce({triangles});
  return simplifier.mesh();
}

}  // namespace

TEST_CASE("a sphere keeps its topology, its count and nearly its volume") {
  const Mesh input = sphere(5);
  for (const std::uint64_t goal : {4000U, 400U, 40U}) {
    CAPTURE(goal);
    const Mesh result = reduced_to(input, goal);
    CHECK(result.triangles.size() == goal);
    CHECK(is_clean(result));
    CHECK(check(result).euler == 2);
    CHECK(check(result).border_edges == 0);
    CHECK(signed_volume(result) ==
          doctest::Approx(4.18879).epsilon(8.0 / static_cast<double>(goal)));
    double farthest = 0;
    for (const Vec3 p : result.positions) farthest = std::max(farthest, std::abs(length(p) - 1));
    CHECK(farthest < 12.0 / static_cast<double>(goal));
  }
}

TEST_CASE("a torus keeps its hole") {
  const Mesh result = reduced_to(wide_torus(120, 60), 150);
  CHECK(result.triangles.size() == 150);
  CHECK(is_clean(result));
  CHECK(check(result).euler == 0);
  CHECK(check(result).components == 1);
}

TEST_CASE("each component stays") {
  Mesh mesh = sphere(3);
  append(mesh, wide_torus(30, 20), {10, 0, 0});
  append(mesh, tetrahedron(), {0, 10, 0});
  const Mesh result = reduced_to(mesh, 60);
  CHECK(result.triangles.size() == 60);
  CHECK(is_clean(result));
  CHECK(check(result).components == 3);
  CHECK(check(result).euler == 4);
}

TEST_CASE("a tetrahedron cannot shrink, and a sphere ends as one") {
  CHECK(reduced_to(tetrahedron(), 0).triangles.size() == 4);
  const Mesh result = reduced_to(sphere(2), 0);
  CHECK(is_clean(result));
  CHECK(check(result).euler == 2);
  CHECK(result.triangles.size() < 32);
}

TEST_CASE("the goal is hit exactly, or from above where the surface is closed") {
  CHECK(reduced_to(sphere(4), 501).triangles.size() == 502);
  for (std::uint64_t goal = 300; goal < 310; ++goal) {
    CAPTURE(goal);
    const Mesh result = reduced_to(wavy_grid(30, 30), goal);
    CHECK(result.triangles.size() == goal);
    CHECK(is_clean(result));
  }
}

TEST_CASE("a mesh of several blocks hits the goal as well") {
  const Mesh input = wavy_grid(200, 200);
  REQUIRE(input.positions.size() > 40000);
  for (const std::uint64_t goal : {60001U, 20000U, 999U}) {
    CAPTURE(goal);
    const Mesh result = reduced_to(input, goal);
    CHECK(result.triangles.size() == goal);
    CHECK(is_clean(result));
    CHECK(check(result).euler == 1);
  }
}

TEST_CASE("the same input gives the same bytes") {
  CHECK(same_bytes(reduced_to(wide_torus(200, 150), 3000), reduced_to(wide_torus(200, 150), 3000)));
}

TEST_CASE("vertices keep their order") {
  const Mesh mesh = wide_torus(40, 40);
  const Mesh result = reduced_to(mesh, 2000);
  // Vertices that never collapsed still have their position in the input.
  std::size_t at = 0;
  std::size_t untouched = 0;
  for (const Vec3 p : result.positions) {
    const auto found = std::find(mesh.positions.begin(), mesh.positions.end(), p);
    if (found == mesh.positions.end()) continue;
    const auto index = static_cast<std::size_t>(found - mesh.positions.begin());
    CHECK(index >= at);
    at = index;
    ++untouched;
  }
  CHECK(untouched > 100);
}

TEST_CASE("reduce goes on from where it stopped") {
  Simplifier simplifier(sphere(5), {});
  int passes = 0;
  const auto count = [&](std::uint64_t) { return ++passes > 0; };
  simplifier.reduce({4000}, count);
  CHECK(simplifier.triangles() == 4000);
  const double first = simplifier.max_cost();
  CHECK(first > 0);
  passes = 0;
  simplifier.reduce({4000}, count);
  simplifier.reduce({5000}, count);
  CHECK(passes == 0);
  simplifier.reduce({100}, count);
  CHECK(simplifier.triangles() == 100);
  CHECK(simplifier.max_cost() > first);
  CHECK(simplifier.free_triangles() == 100);
  CHECK(is_clean(simplifier.mesh()));
}

TEST_CASE("progress counts down and stops the work") {
  Simplifier simplifier(sphere(5), {});
  std::vector<std::uint64_t> left;
  simplifier.reduce({10}, [&](std::uint64_t triangles) {
    left.push_back(triangles);
    return left.size() < 3;
  });
  REQUIRE(left.size() == 3);
  CHECK(left[0] > left[1]);
  CHECK(left[1] > left[2]);
  CHECK(simplifier.triangles() == left[2]);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).euler == 2);
  simplifier.reduce({10});
  CHECK(simplifier.triangles() == 10);
}

TEST_CASE("nothing in, nothing out") {
  CHECK(reduced_to({}, 0).positions.empty());
  CHECK(reduced_to({{{1, 2, 3}}, {}}, 0).positions.empty());
  CHECK(reduced_to({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 0).triangles.size() == 1);
}

TEST_CASE("options that do not fit are refused") {
  CHECK_THROWS_AS(Simplifier(tetrahedron(), {5, PositionType::float64, {}}), UsageError);
  CHECK_THROWS_AS(Simplifier(tetrahedron(), {0, PositionType::float64, {1}}), UsageError);
  Mesh bad = tetrahedron();
  bad.triangles.push_back({0, 1, 4});
  CHECK_THROWS_AS(Simplifier(bad, {}), DataError);
}
