// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "geometry/distance_across.hpp"

using namespace meshfarm;

TEST_CASE("a triangle that is nearer than what is known is found, however narrow it is") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&](double size) {
    return Vec3{unit(random), unit(random), unit(random)} * size;
  };
  int passed_over = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double narrow = std::pow(10, 8 * unit(random) - 8);
    const Vec3 a = point(1), b = a + point(1);
    const Vec3 c = a + (b - a) * unit(random) + point(narrow);
    const Vec3 middle = (a + b + c) * (1.0 / 3);
    const Vec3 p = middle + point(std::pow(10, 8 * unit(random) - 7));
    const DistanceAcross whole = distance_across(p, a, b, c);
    const double known = whole.squared * (1 + 1e-12) + 1e-300;
    const DistanceAcross found = distance_across(p, a, b, c, known);
    REQUIRE(found.squared == whole.squared);
    REQUIRE(found.side == whole.side);
    const DistanceAcross farther = distance_across(p, a, b, c, 0.5 * whole.squared);
    REQUIRE((std::isinf(farther.squared) || farther.squared == whole.squared));
    passed_over += std::isinf(farther.squared) ? 1 : 0;
  }
  CHECK(passed_over > 20'000);
}

TEST_CASE("what is known already is no harm at triangles that are none, or to points on them") {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  CHECK(distance_across({0.2, 0.2, 0}, a, b, c, 0).squared == 0);
  CHECK(std::isinf(distance_across({0.2, 0.2, 1}, a, b, c, 0).squared));
  for (const double known : {HUGE_VAL, 9.0}) {
    CHECK(distance_across({0, 0, 2}, a, a, a, known).squared == 4);
    CHECK(distance_across({0.5, 0, 2}, a, b, Vec3{0.5, 0, 0}, known).squared == 4);
  }
}
