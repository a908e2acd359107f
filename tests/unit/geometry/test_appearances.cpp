// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/simplify/appearance_star.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;

namespace {

constexpr Appearance k_black{};
constexpr Appearance k_white{65535, 65535, 65535, 0};

/// The star of six triangles round a vertex at `centre`, coloured by position.
template <typename Colour>
void add_star(AppearanceStar& star, Vec3 centre, const Colour& colour) {
  const Appearance at_centre = colour(centre);
  for (int i = 0; i < 6; ++i) {
    const auto at = [&](int k) {
      const double angle = k * std::numbers::pi / 3;
      return centre + Vec3{std::cos(angle), std::sin(angle), 0};
    };
    const Appearance p = colour(at(i));
    const Appearance q = colour(at(i + 1));
    star.add(StarTriangle::of(centre, at(i), at(i + 1)), {at_centre, p, q});
  }
}

Appearance ramp(Vec3 p) {
  return {static_cast<std::uint16_t>(30000 + 1000 * p.x),
          static_cast<std::uint16_t>(20000 - 2000 * p.y), 5, 0};
}

Appearance sides(Vec3 p) {
  return p.x > 0.25 ? k_white : k_black;
}

Mesh coloured(Mesh mesh, Appearance (*colour)(Vec3)) {
  for (const Vec3& p : mesh.positions) mesh.appearances.push_back(colour(p));
  return mesh;
}

/// White on one side of a line across the unit square.
Appearance half_white(Vec3 p) {
  return p.x + 0.4 * p.y > 0.7 ? k_white : k_black;
}

/// The number of wrongly coloured vertices away from the line.
std::size_t wrong_colours(const Mesh& mesh, double margin) {
  std::size_t wrong = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = mesh.positions[v];
    const double from_line = p.x + 0.4 * p.y - 0.7;
    if (std::abs(from_line) < margin) continue;
    wrong += (mesh.appearances[v][0] > 32768) == (from_line > 0) ? 0 : 1;
  }
  return wrong;
}

/// The area of the triangles whose corners lie on both sides of the line.
double area_across(const Mesh& mesh, double margin) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    double least = HUGE_VAL;
    double most = -HUGE_VAL;
    for (const std::uint32_t v : {a, b, c}) {
      const Vec3 p = mesh.positions[v];
      least = std::min(least, p.x + 0.4 * p.y - 0.7);
      most = std::max(most, p.x + 0.4 * p.y - 0.7);
    }
    if (least < -margin && most > margin) {
      area += 0.5 * length(cross(mesh.positions[b] - mesh.positions[a],
                                 mesh.positions[c] - mesh.positions[a]));
    }
  }
  return area;
}

Mesh simplified_painted(Mesh mesh, std::uint64_t triangles, double appearance_length) {
  SimplifyOptions options;
  options.lines.appearance_scale.length = appearance_length;
  Simplifier simplifier(std::move(mesh), options);
  simplifier.reduce({.triangles = triangles});
  return simplifier.mesh();
}

}  // namespace

TEST_CASE("one colour costs nothing, and stays") {
  AppearanceStar star;
  star.clear({1});
  add_star(star, {}, [](Vec3) { return Appearance{1, 2, 3, 4}; });
  EdgeQuadric quadric;
  star.add_to(quadric);
  CHECK(quadric.a.trace() == 0);
  CHECK(quadric.c == 0);
  CHECK(star.at({5, 6, 0}) == Appearance{1, 2, 3, 4});
}

TEST_CASE("what is linear costs nothing wherever the vertex goes, and is foretold") {
  AppearanceStar star;
  star.clear({1});
  add_star(star, {-0.5, 0, 0}, ramp);
  add_star(star, {0.5, 0, 0}, ramp);
  EdgeQuadric quadric;
  quadric.squared_length = 1;
  star.add_to(quadric);
  for (const Vec3 x : {Vec3{}, Vec3{0.5, 0, 0}, Vec3{0.25, -0.5, 0}}) {
    // Except for an invisible difference: one level of 256.
    CHECK(std::abs(dot(quadric.a * x - quadric.b * 2.0, x) + quadric.c) < 5e-5);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::abs(star.at(x)[i] - static_cast<int>(ramp(x)[i])) <= 400);
    }
  }
}

TEST_CASE("what no 8 bits can tell costs nothing") {
  const auto rounded = [](Vec3 p) {
    const double level = std::floor(100.8 + 0.3 * p.x + 0.2 * p.y);
    return Appearance{static_cast<std::uint16_t>(257 * level), 0, 0, 0};
  };
  AppearanceStar star;
  star.clear({1});
  add_star(star, {0.5, 0, 0}, rounded);
  CHECK(rounded({0.5, 0, 0}) != rounded({1.5, 0, 0}));
  EdgeQuadric quadric;
  star.add_to(quadric);
  CHECK(quadric.a.trace() == 0);
  CHECK(quadric.c == 0);
}

TEST_CASE("a step costs what leaves it, in the plane and not across it") {
  AppearanceStar star;
  star.clear({0.1});  // gentle enough for all of it to count
  add_star(star, {}, sides);
  const Quadric q = star.quadric();
  CHECK(q.xx > 0.01);
  CHECK(q.zz == doctest::Approx(0));
}

TEST_CASE("steep gradients count no more than others") {
  const auto trace_of = [](double appearance_length) {
    AppearanceStar star;
    star.clear({appearance_length});
    add_star(star, {}, sides);
    return star.quadric().trace();
  };
  CHECK(trace_of(0.02) == doctest::Approx(4 * trace_of(0.01)).epsilon(0.01));
  CHECK(trace_of(200) == doctest::Approx(trace_of(100)).epsilon(0.01));
}

TEST_CASE("a line between two colours stays where the shape is flat") {
  const Mesh input = coloured(simplify_test::flat_grid(80, 80), half_white);
  const Mesh blind = simplified_painted(input, 200, 0);
  CHECK(blind.appearances.empty());
  CHECK(area_across(blind, 0.02) > 0.05);
  const Mesh made = simplified_painted(input, 200, 0.1);
  CHECK(made.triangles.size() == 200);
  REQUIRE(made.appearances.size() == made.positions.size());
  CHECK(wrong_colours(made, 0.02) == 0);
  CHECK(area_across(made, 0.02) < 0.01);
}

TEST_CASE("appearances follow their vertices through dirt and gaps") {
  // Each face twice, once per side; unused vertices; and two pieces that share a vertex.
  Mesh input = coloured(simplify_test::wavy_grid(60, 60), half_white);
  const std::vector<Triangle> once = input.triangles;
  for (const auto& [a, b, c] : once) input.triangles.push_back({a, c, b});
  input.positions.insert(input.positions.begin(), {9, 9, 9});
  input.appearances.insert(input.appearances.begin(), {1, 2, 3, 4});
  for (Triangle& t : input.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
  const Mesh made = simplified_painted(input, 400, 0.05);
  CHECK(made.triangles.size() <= 400);
  REQUIRE(made.appearances.size() == made.positions.size());
  CHECK(wrong_colours(made, 0.05) == 0);
}

TEST_CASE("appearances that are not one a vertex are refused") {
  Mesh mesh = simplify_test::flat_grid(2, 2);
  mesh.appearances.resize(3);
  CHECK_THROWS_AS(Simplifier(mesh, {}), UsageError);
}
