// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Surfaces much narrower than their length and than their triangles: ribbons and pins.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/util/errors.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

constexpr std::uint32_t k_long = 1000;

/// A ribbon two squares, that is `width`, wide and `k_long` long, with waves of that height.
Mesh ribbon(double width, double height) {
  Mesh mesh = grid(2, k_long, [&](double, double along) {
    return height * std::sin(4 * std::numbers::pi * along);
  });
  for (Vec3& p : mesh.positions) p = {p.x * width, p.y * k_long, p.z};
  return mesh;
}

/// Joins rings of `sides` vertices each to a tube, open at both ends.
void join_rings(Mesh& mesh, std::uint32_t sides) {
  for (std::uint32_t first = 0; first + sides < mesh.positions.size(); first += sides) {
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = first + side;
      const std::uint32_t b = first + (side + 1) % sides;
      mesh.triangles.push_back({a, b, b + sides});
      mesh.triangles.push_back({a, b + sides, a + sides});
    }
  }
}

/// A straight tube of six sides, open at both ends.
Mesh pin(double radius) {
  Mesh mesh;
  for (std::uint32_t ring = 0; ring <= k_long; ++ring) {
    for (int side = 0; side < 6; ++side) {
      const double angle = side * std::numbers::pi / 3;
      mesh.positions.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), static_cast<double>(ring)});
    }
  }
  join_rings(mesh, 6);
  return mesh;
}

/// The greater RMS of both directions, divided by the length, with `triangles` triangles left.
double error_at(const Mesh& mesh, std::uint64_t triangles) {
  Simplifier simplifier(mesh, {});
  simplifier.reduce({triangles});
  CHECK(simplifier.triangles() <= triangles);
  CHECK(simplifier.triangles() + 2 >= triangles);
  CHECK(is_clean(simplifier.mesh()));
  DistanceOptions options;
  options.samples = 20000;
  const double there = measure_distance(mesh, simplifier.mesh(), options).rms;
  const double back = measure_distance(simplifier.mesh(), mesh, options).rms;
  return std::max(there, back) / k_long;
}

}  // namespace

TEST_CASE("a straight ribbon keeps its length, however thin it is") {
  for (const double width : {1.0, 1e-2, 1e-4, 1e-5}) {
    CAPTURE(width);
    CHECK(error_at(ribbon(width, 0), 400) < 1e-9);
    CHECK(error_at(ribbon(width, 0), 40) < 1e-6);
  }
}

TEST_CASE("a ribbon that bends keeps its shape where it is thinner than its triangles turn") {
  for (const double width : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    CAPTURE(width);
    CHECK(error_at(ribbon(width, 50), 400) < 2e-4);
    CHECK(error_at(ribbon(width, 50), 100) < 1e-2);
  }
}

TEST_CASE("curved hair keeps its ends") {
  // Two sides, narrower towards the end, half way round a circle.
  Mesh hair = grid(1, 118, [](double, double) { return 0.0; });
  for (Vec3& p : hair.positions) {
    const double angle = std::numbers::pi * p.y;
    const double side = (2 * p.x - 1) * 0.01 * (1 - 0.8 * p.y);
    p = {std::cos(angle), std::sin(angle), side};
  }
  for (const std::uint64_t triangles : {48, 24, 12}) {
    CAPTURE(triangles);
    Simplifier simplifier(hair, {});
    simplifier.reduce({triangles});
    CHECK(simplifier.triangles() == triangles);
    const std::vector<Vec3>& left = simplifier.mesh().positions;
    const auto before = [](const Vec3& p, const Vec3& q) { return p.x < q.x; };
    const double step = 2 * std::numbers::pi / static_cast<double>(triangles);
    CHECK(length(*std::max_element(left.begin(), left.end(), before) - Vec3{1, 0, 0}) < step / 2);
    CHECK(length(*std::min_element(left.begin(), left.end(), before) - Vec3{-1, 0, 0}) < step / 2);
  }
}

TEST_CASE("a straight pin keeps its length, however thin it is") {
  for (const double radius : {1e-1, 1e-2, 1e-3}) {
    CAPTURE(radius);
    CHECK(error_at(pin(radius), 1200) < 1e-9);
    CHECK(error_at(pin(radius), 240) < 1e-6);
  }
}

namespace {

/// A tube of four sides, open at both ends: along a bend it gets thinner, and its rings get
/// farther apart.
Mesh strand(double bend) {
  constexpr std::uint32_t k_rings = 26;
  Mesh mesh;
  for (std::uint32_t ring = 0; ring < k_rings; ++ring) {
    const double share = ring / (k_rings - 1.0);
    const double at = 0.3 * share + 0.9 * share * share;
    const double radius = 0.0034 - 0.003 * share;
    const Vec3 along{std::cos(bend * at), std::sin(bend * at), 0};
    const Vec3 across{-along.y, along.x, 0};
    const Vec3 middle = Vec3{std::sin(bend * at), 1 - std::cos(bend * at), 0} * (1 / bend);
    for (const Vec3& side : {across, Vec3{0, 0, 1}, across * -1.0, Vec3{0, 0, -1}}) {
      mesh.positions.push_back(middle + side * radius);
    }
  }
  join_rings(mesh, 4);
  return mesh;
}

}  // namespace

TEST_CASE("of strands that taper the thick ends keep their shape as well as the thin ones") {
  Mesh strands;
  for (int i = 0; i < 60; ++i) append(strands, strand(0.8 + 0.02 * i), {0, 0, 0.1 * i});
  const auto of = [&](double share) {
    return static_cast<std::uint64_t>(share * static_cast<double>(strands.triangles.size()));
  };
  CHECK(error_at(strands, of(0.43)) < 5.7e-7);
  CHECK(error_at(strands, of(0.3)) < 1.1e-6);
}

TEST_CASE("a stretched surface is no ribbon: none of its triangles turns over") {
  Mesh mesh = grid(60, 60, [](double, double along) { return 0.05 * std::sin(9 * along); });
  for (Vec3& p : mesh.positions) p.x *= 1e-4;
  Simplifier simplifier(mesh, {});
  simplifier.reduce({600});
  CHECK(simplifier.triangles() == 600);
  CHECK(is_clean(simplifier.mesh()));
  for (const Triangle& t : simplifier.mesh().triangles) {
    const auto at = [&](std::size_t corner) {
      Vec3 p = simplifier.mesh().positions[t[corner]];
      p.x *= 1e4;
      return p;
    };
    CHECK(cross(at(1) - at(0), at(2) - at(0)).z > 0);
  }
}

namespace {

/// The box with the diagonals of top and bottom across each other.
Mesh crossed(Mesh box) {
  box.triangles[2] = {4, 5, 6};
  box.triangles[3] = {5, 7, 6};
  return box;
}

constexpr std::uint32_t k_plates = 50;

Mesh plates() {
  Mesh mesh;
  for (std::uint32_t i = 0; i < k_plates; ++i) {
    const Mesh plate = test::box({4, 3 + 0.01 * i, 0.1});
    append(mesh, i % 2 == 0 ? plate : crossed(plate), {0, 0, 3.0 * i});
  }
  return mesh;
}

}  // namespace

TEST_CASE("closed plates become sheets where there is no room for both of their sides") {
  const Mesh mesh = plates();
  for (const std::uint64_t goal : {std::uint64_t{3} * k_plates, std::uint64_t{2} * k_plates}) {
    CAPTURE(goal);
    Simplifier simplifier(mesh, {});
    simplifier.reduce({.triangles = goal});
    CHECK(simplifier.triangles() == goal);
    CHECK(simplifier.simplifies_topology());
    CHECK(check(simplifier.mesh()).components == k_plates);
    CHECK(is_clean(simplifier.mesh()));
    CHECK(measure_distance(mesh, simplifier.mesh(), {.samples = 20'000}).rms < 0.12);
    CHECK(measure_distance(simplifier.mesh(), mesh, {.samples = 20'000}).rms < 0.12);
  }
}

TEST_CASE("plates stay closed with the topology, and where nothing may cross") {
  const Mesh mesh = plates();
  Simplifier keeps(mesh, {.lines = {.topology = TopologyMode::keep}});
  Simplifier avoids(
      mesh, {.lines = {.topology = TopologyMode::simplify, .crossings = CrossingMode::avoid}});
  for (Simplifier* simplifier : {&keeps, &avoids}) {
    simplifier->reduce({.triangles = 3 * k_plates});
    CHECK(measure_topology(simplifier->mesh()).border_edges == 0);
  }
  CHECK(keeps.triangles() == 4 * k_plates);
  CHECK(avoids.triangles() == 3 * k_plates / 4 * 4);
}

namespace {

/// A closed plate, and a square that is larger than one side of it, but not than both.
Mesh plate_and_square() {
  Mesh mesh = test::box({2, 2, 0.01});
  append(mesh, Mesh{{{0, 0, 0}, {2.2, 0, 0}, {2.2, 2.2, 0}, {0, 2.2, 0}}, {{0, 1, 2}, {0, 2, 3}}},
         {0, 0, 50});
  return mesh;
}

std::int64_t triangles_of_plate(const Mesh& mesh) {
  return std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                       [&](const Triangle& t) { return mesh.positions[t[0]].z < 1; });
}

}  // namespace

TEST_CASE("what is left of a closed plate stands for both of its sides") {
  Simplifier simplifier(plate_and_square(), {.lines = {.topology = TopologyMode::simplify}});
  simplifier.reduce({.triangles = 3});
  CHECK(simplifier.triangles() == 3);
  CHECK(triangles_of_plate(simplifier.mesh()) == 2);
}

TEST_CASE("the next simplifier is told which sheets were closed") {
  Simplifier first(plate_and_square(), {.lines = {.topology = TopologyMode::simplify}});
  first.reduce({.triangles = 4});
  REQUIRE(triangles_of_plate(first.mesh()) == 2);
  const std::vector<std::uint32_t> opened = first.opened();
  CHECK(opened.size() == 4);
  for (const std::uint32_t v : opened) CHECK(first.mesh().positions[v].z < 1);
  for (const bool is_told : {true, false}) {
    CAPTURE(is_told);
    Simplifier next(first.mesh(), {.opened = is_told ? opened : std::vector<std::uint32_t>(),
                                   .lines = {.topology = TopologyMode::simplify}});
    next.reduce({.triangles = 3});
    CHECK(triangles_of_plate(next.mesh()) == (is_told ? 2 : 1));
    CHECK(next.opened().size() == (is_told ? 4 : 0));
  }
  CHECK_THROWS_AS(Simplifier(plate_and_square(), {.opened = {99}}), UsageError);
}
