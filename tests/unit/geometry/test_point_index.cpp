// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <meshfarm/geometry/point_index.hpp>

using namespace meshfarm;

namespace {

std::vector<Vec3> random_points(std::size_t count) {
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<double>(random()) / 0x1p32; };
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {unit(), unit(), unit()};
  return points;
}

}  // namespace

TEST_CASE("point index: the nearest, nearest first") {
  const std::vector<Vec3> points = random_points(2000);
  const PointIndex index(points);
  for (const Vec3 from : random_points(50)) {
    std::vector<double> all;
    for (const Vec3& p : points) all.push_back(squared_length(p - from));
    std::sort(all.begin(), all.end());
    std::array<std::uint32_t, 5> found{};
    REQUIRE(index.nearest(from, found) == 5);
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(squared_length(points[found[i]] - from) == doctest::Approx(all[i]));
    }
  }
  std::array<std::uint32_t, 5> found{};
  CHECK(PointIndex({{0, 0, 0}, {1, 0, 0}}).nearest({2, 0, 0}, found) == 2);
  CHECK(found[0] == 1);
}

TEST_CASE("point index: the least value of those that are near") {
  const std::vector<Vec3> points = random_points(2000);
  const PointIndex index(points);
  for (const Vec3 from : random_points(50)) {
    // Only some points count, and some of those as if they were a little farther.
    const auto value = [&](std::uint32_t point) {
      const double squared = squared_length(points[point] - from);
      return point % 50 == 7 ? squared * (point % 3 == 0 ? 1.2 : 1.0) : HUGE_VAL;
    };
    double least = HUGE_VAL;
    for (std::uint32_t i = 0; i < points.size(); ++i) least = std::min(least, value(i));
    CHECK(index.least(from, HUGE_VAL, value) == doctest::Approx(least));
    CHECK(index.least(from, 2 * least, value) == doctest::Approx(least));
    CHECK(index.least(from, least / 2, value) == least / 2);
  }
  CHECK(std::isinf(index.least({}, HUGE_VAL, [](std::uint32_t) { return HUGE_VAL; })));
  CHECK(std::isinf(PointIndex({}).least({}, HUGE_VAL, [](std::uint32_t) { return 1.0; })));
}
