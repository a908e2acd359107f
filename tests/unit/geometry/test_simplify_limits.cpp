// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

Mesh put_at(Mesh mesh, Vec3 by) {
  for (Vec3& p : mesh.positions) p = p + by;
  return mesh;
}

double farthest_from_unit_sphere(const Mesh& mesh, Vec3 centre) {
  double farthest = 0;
  for (const Vec3 p : mesh.positions) {
    farthest = std::max(farthest, std::abs(length(p - centre) - 1));
  }
  return farthest;
}

/// A closed cylinder along z, of radius 0.04 and height 1.2.
Mesh pin(std::uint32_t sides, std::uint32_t rings) {
  Mesh mesh = grid(sides, rings, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) {
    const double turn = 2 * std::numbers::pi * p.x;
    p = {0.04 * std::cos(turn), 0.04 * std::sin(turn), 1.2 * p.y};
  }
  const std::uint32_t row = sides + 1;
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = v % row == sides ? v - sides : v;
  }
  const auto bottom = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({0, 0, 0});
  mesh.positions.push_back({0, 0, 1.2});
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    mesh.triangles.push_back({bottom, next, i});
    mesh.triangles.push_back({bottom + 1, rings * row + i, rings * row + next});
  }
  return mesh;
}

/// A plate of squares of side 1, 0.1 thick, with a hole of 12 sides and radius 0.05 through the
/// middle of each.
Mesh drilled_plate(std::uint32_t columns, std::uint32_t rows) {
  constexpr std::uint32_t k_sides = 12;
  constexpr double k_radius = 0.05;
  constexpr double k_thickness = 0.1;
  const std::uint32_t corners = (columns + 1) * (rows + 1);
  const std::uint32_t layer = corners + k_sides * columns * rows;  // vertices of the bottom
  Mesh mesh;
  for (const double z : {0.0, k_thickness}) {
    for (std::uint32_t y = 0; y <= rows; ++y) {
      for (std::uint32_t x = 0; x <= columns; ++x) {
        mesh.positions.push_back({static_cast<double>(x), static_cast<double>(y), z});
      }
    }
    for (std::uint32_t y = 0; y < rows; ++y) {
      for (std::uint32_t x = 0; x < columns; ++x) {
        for (std::uint32_t k = 0; k < k_sides; ++k) {
          const double turn = 2 * std::numbers::pi * k / k_sides;
          mesh.positions.push_back(
              {x + 0.5 + k_radius * std::cos(turn), y + 0.5 + k_radius * std::sin(turn), z});
        }
      }
    }
  }
  const auto add_on_both = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({layer + a, layer + b, layer + c});
    mesh.triangles.push_back({a, c, b});
  };
  const auto add_wall = [&](std::uint32_t from, std::uint32_t to) {
    mesh.triangles.push_back({layer + from, layer + to, to});
    mesh.triangles.push_back({layer + from, to, from});
  };
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t low = y * (columns + 1) + x;
      const std::uint32_t high = low + columns + 1;
      const std::array<std::uint32_t, 4> round{high + 1, high, low, low + 1};
      const std::uint32_t hole = corners + k_sides * (y * columns + x);
      for (std::uint32_t k = 0; k < k_sides; ++k) {
        const std::uint32_t quarter = k / (k_sides / 4);
        const std::uint32_t next = hole + (k + 1) % k_sides;
        add_on_both(hole + k, round[quarter], next);
        add_wall(hole + k, next);
        if (k % (k_sides / 4) == 0) add_on_both(hole + k, round[(quarter + 3) % 4], round[quarter]);
      }
    }
  }
  const std::uint32_t last_row = rows * (columns + 1);
  for (std::uint32_t x = 0; x < columns; ++x) {
    add_wall(x + 1, x);
    add_wall(last_row + x, last_row + x + 1);
  }
  for (std::uint32_t y = 0; y < rows; ++y) {
    const std::uint32_t left = y * (columns + 1);
    add_wall(left, left + columns + 1);
    add_wall(left + 2 * columns + 1, left + columns);
  }
  return mesh;
}

}  // namespace

TEST_CASE("no collapse costs more than max_cost") {
  Simplifier simplifier(sphere(5), {});
  std::uint64_t before = simplifier.triangles();
  for (const double limit : {1e-8, 1e-7, 1e-5}) {
    CAPTURE(limit);
    simplifier.reduce({0, limit});
    CHECK(simplifier.max_cost() <= limit);
    CHECK(simplifier.pass_cost() <= limit);
    CHECK(simplifier.max_cost() > limit / 4);
    CHECK(simplifier.triangles() < before);
    before = simplifier.triangles();
    CHECK(is_clean(simplifier.mesh()));
    int passes = 0;
    simplifier.reduce({0, limit}, [&](std::uint64_t) { return ++passes > 0; });
    CHECK(passes == 0);
  }
  CHECK(before > 8);
}

TEST_CASE("the level reached is that of what has collapsed, not of what is refused") {
  Mesh mesh;
  for (int i = 0; i < 200; ++i) append(mesh, test::octahedron(), {3.0 * i, 0, 0});
  // Tetrahedra are left, whose edges rank as if they cost nothing.
  for (const TopologyMode topology : {TopologyMode::keep_while_fair, TopologyMode::simplify}) {
    Simplifier simplifier(mesh, {.lines = {.topology = topology}});
    simplifier.reduce({.triangles = 790, .in_passes = true});
    CHECK(simplifier.triangles() < 900);
    CHECK(simplifier.pass_cost() > simplifier.max_cost() / 2);
    simplifier.reduce({.triangles = 780});
    CHECK(simplifier.pass_cost() > simplifier.max_cost() / 16);
  }
}

TEST_CASE("the level reached is that of the goal, not of the last pass") {
  Simplifier simplifier(sphere(5), {});
  simplifier.reduce({1001});
  CHECK(simplifier.triangles() == 1002);
  const double level = simplifier.pass_cost();
  CHECK(level > 0);
  CHECK(level <= 2 * simplifier.max_cost());
  simplifier.reduce({0, level});
  CHECK(simplifier.triangles() > 700);
  simplifier.reduce({0});
  CHECK(simplifier.pass_cost() > level);
  CHECK(simplifier.pass_cost() <= simplifier.max_cost());
}

TEST_CASE("goals in small steps are met exactly, whatever cost they allow") {
  for (const double max_cost : {1.0, HUGE_VAL}) {
    Simplifier grid(wavy_grid(30, 30), {});
    for (std::uint64_t goal = 1500; goal > 1480; --goal) {
      grid.reduce({goal, max_cost});
      CHECK(grid.triangles() == goal);
    }
    Simplifier ball(sphere(4), {});
    for (std::uint64_t goal = 1500; goal > 1480; --goal) {
      ball.reduce({goal, max_cost});
      CHECK(ball.triangles() == goal + goal % 2);
    }
  }
}

TEST_CASE("max_cost is nearly exhausted by one call") {
  Simplifier once(wavy_grid(100, 100), {});
  once.reduce({0, 1e-8});
  Simplifier twice(wavy_grid(100, 100), {});
  twice.reduce({0, 1e-9});
  twice.reduce({0, 1e-8});
  const auto a = static_cast<double>(once.triangles());
  const auto b = static_cast<double>(twice.triangles());
  CHECK(a == doctest::Approx(b).epsilon(0.1));
}

TEST_CASE("one triangle too many, which cannot go, is no end of what a cost allows") {
  Mesh mesh = sphere(4);
  mesh.triangles.pop_back();  // a hole of three edges
  Simplifier simplifier(mesh, {.lines = {.topology = TopologyMode::keep}});
  simplifier.reduce({900});  // so few that one fewer would not be as good
  REQUIRE(simplifier.triangles() == 901);
  simplifier.reduce({0, 4 * simplifier.pass_cost()});
  CHECK(simplifier.triangles() < 675);
  CHECK(is_clean(simplifier.mesh()));
}

TEST_CASE("costs that rise in small steps lead to about the same as one") {
  Mesh noisy = sphere(6);
  std::uint32_t random = 1;
  for (Vec3& p : noisy.positions) {
    random = random * 1664525 + 1013904223;
    p = p * (1 + 0.01 * (random >> 8) / 0x1p24);
  }
  const auto error_of = [&](const Simplifier& simplifier) {
    return DistanceMeter(simplifier.mesh(), 1)
        .measure(sample_surface(noisy, {20'000, 1}).points)
        .rms;
  };
  Simplifier steps(noisy, {});
  steps.reduce({12'000});
  const double first = steps.max_cost();
  int still = 0;
  for (double cost = first / 1024; cost < 64 * first; cost *= 1.3) {
    const std::uint64_t before = steps.triangles();
    steps.reduce({2000, cost});
    if (steps.triangles() == before) ++still;
    CHECK(steps.max_cost() <= std::max(first, cost) * 1.001);
  }
  CHECK(still > 10);  // below the cost already paid there is little to do
  steps.reduce({2000});
  Simplifier at_once(noisy, {});
  at_once.reduce({2000});
  CHECK(steps.triangles() == 2000);
  CHECK(at_once.triangles() == 2000);
  CHECK(error_of(steps) < 1.1 * error_of(at_once));
}

TEST_CASE("costs do not depend on where a part lies") {
  Simplifier here(wavy_grid(60, 60), {});
  here.reduce({1000});
  Simplifier there(put_at(wavy_grid(60, 60), {4096, -4096, 4096}), {});
  there.reduce({1000});
  CHECK(here.pass_cost() == doctest::Approx(there.pass_cost()).epsilon(0.1));
  CHECK(here.max_cost() == doctest::Approx(there.max_cost()).epsilon(0.1));
}

TEST_CASE("far from the origin nothing is lost") {
  const Vec3 centre{1e6, -2e6, 3e6};
  Simplifier simplifier(put_at(sphere(5), centre), {});
  simplifier.reduce({400});
  CHECK(simplifier.triangles() == 400);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(farthest_from_unit_sphere(simplifier.mesh(), centre) < 0.02);
}

TEST_CASE("tiny and huge meshes are treated alike") {
  for (const double scale : {1e-15, 1e15}) {
    Mesh mesh = sphere(4);
    for (Vec3& p : mesh.positions) p = p * scale;
    Simplifier simplifier(mesh, {});
    simplifier.reduce({200});
    CHECK(simplifier.triangles() == 200);
    Mesh result = simplifier.mesh();
    for (Vec3& p : result.positions) p = p * (1 / scale);
    CHECK(is_clean(result));
    CHECK(farthest_from_unit_sphere(result, {}) < 0.05);
  }
}

TEST_CASE("float32 results survive being written as float32") {
  SimplifyOptions options;
  options.positions = PositionType::float32;
  // A triangle is about 16 float steps wide.
  Mesh mesh = put_at(sphere(4), {50000, 50000, 50000});
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  const std::uint64_t flat_before = check(mesh).no_area;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({300});
  CHECK(simplifier.triangles() == 300);
  for (const Vec3 p : simplifier.mesh().positions) {
    CHECK(p == rounded(p, PositionType::float32));
  }
  CHECK(flat_before == 0);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).euler == 2);
}

namespace {

/// A needle of four sides on x = 5, from z = 0 to a little over 1.
Mesh needle(double radius, std::uint32_t rings) {
  Mesh mesh;
  constexpr std::uint32_t k_sides = 4;
  for (std::uint32_t r = 0; r <= rings; ++r) {
    for (std::uint32_t s = 0; s < k_sides; ++s) {
      const double angle = 2 * std::numbers::pi * s / k_sides;
      mesh.positions.push_back(
          {5 + radius * std::cos(angle), radius * std::sin(angle), static_cast<double>(r) / rings});
    }
  }
  const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({5, 0, 1 + radius});
  for (std::uint32_t s = 0; s < k_sides; ++s) {
    const std::uint32_t n = (s + 1) % k_sides;
    for (std::uint32_t low = 0; low < rings * k_sides; low += k_sides) {
      const std::uint32_t high = low + k_sides;
      mesh.triangles.push_back({low + s, low + n, high + n});
      mesh.triangles.push_back({low + s, high + n, high + s});
    }
    mesh.triangles.push_back({rings * k_sides + s, rings * k_sides + n, tip});
  }
  return mesh;
}

}  // namespace

TEST_CASE("a thin spike does not draw back before wavy ground is coarse") {
  for (const std::uint32_t rings : {10U, 40U, 100U}) {
    CAPTURE(rings);
    Mesh mesh = wavy_grid(40, 40);
    append(mesh, needle(0.001, rings), {});
    Simplifier simplifier(mesh, {});
    simplifier.reduce({300});
    double highest = 0;
    for (const Vec3 p : simplifier.mesh().positions) {
      if (p.x > 4) highest = std::max(highest, p.z);
    }
    CHECK(highest == doctest::Approx(1).epsilon(0.03));
  }
}

namespace {

/// A pillar of radius 1, each of its sides two needles. Strips of triangles close the ends.
Mesh pillar(std::uint32_t sides, double height) {
  Mesh mesh;
  for (const double z : {0.0, height}) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double angle = 2 * std::numbers::pi * s / sides;
      mesh.positions.push_back({std::cos(angle), std::sin(angle), z});
    }
  }
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t n = (s + 1) % sides;
    mesh.triangles.push_back({s, n, n + sides});
    mesh.triangles.push_back({s, n + sides, s + sides});
  }
  const auto cap = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + sides, b + sides, c + sides});
  };
  for (std::uint32_t low = 0, high = sides - 1; low + 1 < high; ++low) {
    cap(low, low + 1, high);
    if (low + 2 < high) cap(low + 1, high - 1, high);
    --high;
  }
  return mesh;
}

}  // namespace

TEST_CASE("needles that stand on a fine rim do not lock it") {
  const Mesh mesh = pillar(2000, 30);
  REQUIRE(check(mesh).euler == 2);
  Simplifier simplifier(mesh, {});
  simplifier.reduce({120});
  CHECK(simplifier.triangles() == 120);
  CHECK(measure_distance(mesh, simplifier.mesh(), {.samples = 20'000}).rms < 0.003);
}

TEST_CASE("steep folds stay while edges along them go for nothing") {
  // The shortest edge of a vertex leads across a fold, or down its side.
  constexpr std::uint32_t k_cells = 200;
  const Mesh mesh = grid(k_cells, k_cells, [](double x, double) {
    return std::lround(x * k_cells) % 4 < 2 ? 5.0 / k_cells : 0.0;
  });
  const auto all = static_cast<double>(mesh.triangles.size());
  for (const double between : {0.6, 0.42}) {
    CAPTURE(between);
    Mesh made = mesh;
    for (const double share : {between, 0.1}) {
      Simplifier simplifier(std::move(made), {});
      simplifier.reduce({static_cast<std::uint64_t>(share * all)});
      made = simplifier.mesh();
    }
    CHECK(made.triangles.size() == static_cast<std::uint64_t>(0.1 * all));
    CHECK(measure_distance(mesh, made, {.samples = 20'000}).max < 1e-6);
    CHECK(measure_distance(made, mesh, {.samples = 20'000}).max < 1e-6);
  }
}

TEST_CASE("thin pins can become tetrahedra, and none of them goes before") {
  // A prism of three sides has eight triangles: to have fewer, two of its sides turn by 60 degrees.
  constexpr std::uint32_t k_pins = 60;
  Mesh pins;
  for (std::uint32_t i = 0; i < k_pins; ++i) append(pins, pin(16, 20), {0.5 * i, 0, 0});
  Simplifier simplifier(pins, {});
  simplifier.reduce({.triangles = 4 * k_pins});
  CHECK(simplifier.triangles() == 4 * k_pins);
  CHECK(check(simplifier.mesh()).components == k_pins);
  CHECK(is_clean(simplifier.mesh()));
}

TEST_CASE("a pin whose ends are twisted gives up an end, not its length") {
  // At its tip half of the triangles face against the others.
  const Mesh pin{
      {{-0.30, -0.29, 0.0},
       {-0.27, 0.09, 9.0},
       {-0.15, 0.17, 0.0},
       {0.08, -0.58, 9.1},
       {0.26, 0.07, 9.0},
       {0.29, -0.28, -0.1}},
      {{2, 0, 1}, {2, 4, 5}, {2, 1, 4}, {2, 5, 0}, {1, 0, 3}, {1, 3, 4}, {0, 5, 3}, {3, 5, 4}}};
  REQUIRE(check(pin).euler == 2);
  Simplifier simplifier(pin, {});
  simplifier.reduce({.triangles = 6});
  CHECK(simplifier.triangles() == 6);
  for (const Vec3& p : simplifier.mesh().positions) CHECK(std::abs(p.z - 4.5) > 4.2);
}

TEST_CASE("straight edges go before what is round, however long they are") {
  constexpr std::uint32_t k_sides = 30;
  Mesh pins;
  for (std::uint32_t i = 0; i < 20; ++i) append(pins, pin(k_sides, 40), {0.5 * i, 0, 0});
  for (Vec3& p : pins.positions) {  // along no axis, as floats
    const Vec3 turned{0.6 * p.x + 0.8 * p.y, 0.48 * p.y - 0.64 * p.x + 0.6 * p.z,
                      0.36 * p.y - 0.48 * p.x - 0.8 * p.z};
    p = rounded(turned, PositionType::float32);
  }
  Simplifier simplifier(pins, {.positions = PositionType::float32});
  constexpr std::uint64_t k_exact = 2 * k_sides + 2 * (k_sides - 2);
  simplifier.reduce({.triangles = 20 * (k_exact + k_exact / 5)});
  CHECK(measure_distance(pins, simplifier.mesh(), {.samples = 50'000}).rms < 1e-4);
}

TEST_CASE("small holes through a plate close before it loses a corner") {
  // Closing a hole of three sides turns its walls by more than 60 degrees.
  const Mesh plate = drilled_plate(5, 4);
  REQUIRE(check(plate).euler == 2 - 2 * 20);
  REQUIRE(is_clean(plate));
  for (const std::uint64_t goal : {200, 100, 50}) {
    CAPTURE(goal);
    Simplifier simplifier(plate, {});
    simplifier.reduce({.triangles = goal});
    CHECK(simplifier.triangles() == goal);
    CHECK(measure_distance(plate, simplifier.mesh(), {.samples = 50'000}).rms < 0.01);
    CHECK(measure_distance(simplifier.mesh(), plate, {.samples = 50'000}).rms < 0.01);
  }
}
