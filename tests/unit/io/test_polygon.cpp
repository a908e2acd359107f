// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "io/polygon.hpp"

using namespace meshfarm;

namespace {

using CutTriangles = std::vector<std::array<std::uint32_t, 3>>;

CutTriangles cut(const std::vector<Vec3>& corners) {
  PolygonCutter cutter;
  const auto found = cutter.cut(corners);
  CHECK(cutter.failed() == 0);
  return {found.begin(), found.end()};
}

/// Twice the area of the triangles, each of which must face in the direction `up`.
double area_facing(const std::vector<Vec3>& corners, const CutTriangles& triangles, Vec3 up) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 normal = cross(corners[b] - corners[a], corners[c] - corners[a]);
    CHECK(dot(normal, up) > 0);
    area += length(normal);
  }
  return area;
}

}  // namespace

TEST_CASE("convex polygons become fans") {
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) == CutTriangles{{0, 1, 2}, {0, 2, 3}});
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}) == CutTriangles{{0, 1, 2}, {0, 2, 3}});
  std::vector<Vec3> round;
  for (int i = 0; i < 9; ++i) round.push_back({5, std::cos(0.6 * i), std::sin(0.6 * i)});
  const CutTriangles fan = cut(round);
  REQUIRE(fan.size() == 7);
  for (std::uint32_t i = 0; i < 7; ++i) CHECK(fan[i] == std::array{0U, i + 1, i + 2});
}

TEST_CASE("a concave quad is cut along its inner diagonal, whichever corner it begins with") {
  //      2
  //     /|\          The inner diagonal is 1-3 or 0-2, never the outer one.
  //    / 3 \         .
  //   /.' '.\        .
  //  0       1
  std::vector<Vec3> corners{{0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {1, 3, 0}};  // concave at 1
  for (int turn = 0; turn < 4; ++turn) {
    CAPTURE(turn);
    const CutTriangles found = cut(corners);
    CHECK(found.size() == 2);
    CHECK(area_facing(corners, found, {0, 0, 1}) == doctest::Approx(4));
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
}

TEST_CASE("concave polygons in any plane are cut into triangles inside") {
  // A comb of five teeth, seen from below, and tilted.
  std::vector<Vec3> comb{{0, 0, 0}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    const double x = 2.0 * tooth;
    comb.insert(comb.begin() + 1, {{x, 3, 0}, {x + 1, 3, 0}, {x + 1, 1, 0}, {x + 2, 1, 0}});
  }
  comb.push_back({10, 0, 0});
  const double area = 2 * (10 * 1 + 5 * 2);
  CHECK(area_facing(comb, cut(comb), {0, 0, -1}) == doctest::Approx(area));
  std::vector<Vec3> tilted = comb;
  for (Vec3& p : tilted) p = {500'000 + p.y, 5'000'000 + 0.6 * p.x, 0.8 * p.x};
  const CutTriangles found = cut(tilted);
  CHECK(found.size() == tilted.size() - 2);
  CHECK(area_facing(tilted, found, {0, -0.8, 0.6}) == doctest::Approx(area));

  std::vector<Vec3> spiral;
  for (int i = 0; i < 200; ++i)
    spiral.push_back({0.1 * i * std::cos(0.1 * i), 0.1 * i * std::sin(0.1 * i), 0});
  for (int i = 199; i > 0; --i)
    spiral.push_back({(0.1 * i - 0.3) * std::cos(0.1 * i), (0.1 * i - 0.3) * std::sin(0.1 * i), 0});
  CHECK(cut(spiral).size() == spiral.size() - 2);
}

TEST_CASE("corners on a straight side leave no triangle without area") {
  const std::vector<Vec3> side{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}};
  CHECK(area_facing(side, cut(side), {0, 0, 1}) > 0);
  const std::vector<Vec3> quad{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  CHECK(area_facing(quad, cut(quad), {0, 0, 1}) == doctest::Approx(4));
}

TEST_CASE("what has no area becomes a fan, what crosses itself is counted, and nothing hangs") {
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size() == 2);
  CHECK(cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).size() == 3);
  CHECK(cut({{0, 0, 0}, {NAN, NAN, NAN}, {2, 0, 0}, {3, 1, 0}}) ==
        CutTriangles{{0, 1, 2}, {0, 2, 3}});
  PolygonCutter cutter;
  std::vector<Vec3> star;  // with a long way through its middle
  for (int i = 0; i < 20'001; ++i) star.push_back({std::cos(2.5 * i), std::sin(2.5 * i), 0});
  CHECK(cutter.cut(star).size() == star.size() - 2);
}
