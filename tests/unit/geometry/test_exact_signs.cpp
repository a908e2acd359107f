// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "geometry/exact_signs.hpp"

using namespace meshfarm;

namespace {

__extension__ using Wide = __int128;

/// side_of_plane() for whole numbers below 2^40.
int slow_side(const std::array<std::array<std::int64_t, 3>, 4>& p) {
  const auto at = [&](std::size_t i, std::size_t k) -> Wide { return p[i][k] - p[0][k]; };
  const Wide volume = at(1, 0) * (at(2, 1) * at(3, 2) - at(2, 2) * at(3, 1)) +
                      at(1, 1) * (at(2, 2) * at(3, 0) - at(2, 0) * at(3, 2)) +
                      at(1, 2) * (at(2, 0) * at(3, 1) - at(2, 1) * at(3, 0));
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

Vec3 next_above(Vec3 p) {
  return {p.x, p.y, std::nextafter(p.z, HUGE_VAL)};
}

/// A parallelogram whose corners are exact, up to 2^51 from the origin.
struct Parallelogram {
  Vec3 a, b, c, d;
};

Parallelogram make_parallelogram(std::mt19937_64& random) {
  const auto draw = [&](double from, double to) {
    return std::floor(std::uniform_real_distribution<double>(from, to)(random));
  };
  const Vec3 a{draw(0, 0x1p50), draw(0, 0x1p50), draw(0x1p49, 0x1p50)};
  const Vec3 u{draw(1, 0x1p49), draw(0, 1000), draw(0, 0x1p49)};
  const Vec3 v{draw(0, 1000), draw(1, 0x1p49), draw(0, 0x1p49)};
  return {a, a + u, a + v, a + u + v};
}

}  // namespace

TEST_CASE("sides of planes are those of whole numbers, however flat the points lie") {
  std::mt19937_64 random(7);
  int flat = 0;
  for (int round = 0; round < 20'000; ++round) {
    const std::int64_t spread = round % 2 == 0 ? 3 : std::int64_t{1} << 30;
    std::uniform_int_distribution<std::int64_t> draw(-spread, spread);
    std::array<std::array<std::int64_t, 3>, 4> p{};
    std::array<Vec3, 4> q;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::int64_t& x : p[i]) x = draw(random);
      if (i == 3 && round % 3 == 0) {
        for (std::size_t k = 0; k < 3; ++k) p[3][k] = p[1][k] + p[2][k] - p[0][k];
        p[3][2] += round % 9 / 3 - 1;
      }
      q[i] = Vec3{static_cast<double>(p[i][0]), static_cast<double>(p[i][1]),
                  static_cast<double>(p[i][2])} *
             0x1p-20;
    }
    const int side = slow_side(p);
    flat += side == 0 ? 1 : 0;
    REQUIRE(side_of_plane(q[0], q[1], q[2], q[3]) == side);
    REQUIRE(exact_side_of_plane(q[0], q[1], q[2], q[3]) == side);
    REQUIRE(side_of_plane(q[1], q[0], q[2], q[3]) == -side);
  }
  CHECK(flat > 1000);
}

TEST_CASE("sides of planes see the last bit of numbers of all lengths") {
  std::mt19937_64 random(8);
  for (int round = 0; round < 2000; ++round) {
    auto [a, b, c, d] = make_parallelogram(random);
    const double scale = std::ldexp(1.0, round % 400 - 200);
    for (Vec3* p : {&a, &b, &c, &d}) *p = *p * scale;
    REQUIRE(side_of_plane(a, b, c, d) == 0);
    REQUIRE(side_of_plane(a, b, c, next_above(d)) == 1);
    REQUIRE(side_of_plane(a, c, b, next_above(d)) == -1);
    REQUIRE(side_of_plane(d, c, b, a) == 0);
  }
  // Some points are near the origin, some far: their differences do not fit into a double.
  const Vec3 a{0x1p-60, 0, 0}, b{1, 0x1p-70, 0}, c{0, 1, 0};
  CHECK(side_of_plane(a, b, c, {0.5, 0.5, 0}) == 0);
  CHECK(side_of_plane(a, b, c, {0.5, 0.5, 0x1p-80}) == 1);
  CHECK(side_of_plane({0x1p-60, 0, 0x1p-60}, {1, 0, 1}, {0, 1, 0}, {0.5, 0.25, 0.5}) == 0);
  CHECK(side_of_plane({0x1p-60, 0, 0x1p-59}, {1, 0, 1}, {0, 1, 0}, {0.5, 0.25, 0.5}) != 0);
}

TEST_CASE("turns are exact in each plane of coordinates") {
  for (const Axes axes : {Axes{0, 1}, Axes{1, 2}, Axes{2, 0}}) {
    const auto at = [&](double first, double second) {
      std::array<double, 3> p{5, 5, 5};
      p[static_cast<std::size_t>(axes.first)] = first;
      p[static_cast<std::size_t>(axes.second)] = second;
      return Vec3{p[0], p[1], p[2]};
    };
    CHECK(turn(at(0, 0), at(1, 0), at(0, 1), axes) == 1);
    CHECK(turn(at(0, 0), at(0, 1), at(1, 0), axes) == -1);
    // On a line through points that are not multiples of each other in doubles.
    const double third = 1.0 / 3;
    CHECK(turn(at(-third, -third), at(third, third), at(0.7, 0.7), axes) == 0);
    CHECK(turn(at(-third, -third), at(third, third), at(0.7, std::nextafter(0.7, 1.0)), axes) == 1);
    CHECK(turn(at(-third, -third), at(third, third), at(0.7, std::nextafter(0.7, 0.0)), axes) ==
          -1);
    CHECK(turn(at(1, 1), at(1, 1), at(1, 1), axes) == 0);
  }
}
