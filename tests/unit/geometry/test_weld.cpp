// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>

#include <doctest/doctest.h>

#include <meshfarm/geometry/weld.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

using Indices = std::vector<std::uint32_t>;

/// weld() by looking at every pair.
WeldResult weld_slowly(const std::vector<Vec3>& positions) {
  WeldResult result;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    std::uint32_t twin = 0;
    while (!(positions[twin] == positions[i])) ++twin;
    result.first.push_back(twin);
    result.merged += twin != i;
  }
  return result;
}

}  // namespace

TEST_CASE("weld: nothing in, nothing out") {
  const WeldResult result = weld({});
  CHECK(result.first.empty());
  CHECK(result.merged == 0);
}

TEST_CASE("weld: the lowest twin stands for all") {
  const std::vector<Vec3> positions{{1, 2, 3}, {3, 2, 1}, {1, 2, 3},
                                    {0, 0, 0}, {3, 2, 1}, {1, 2, 3}};
  const WeldResult result = weld(positions);
  CHECK(result.first == Indices{0, 1, 0, 3, 1, 0});
  CHECK(result.merged == 3);
}

TEST_CASE("weld: -0.0 is 0.0, the next float is not") {
  const double next = std::numeric_limits<double>::denorm_min();
  const std::vector<Vec3> positions{
      {0, -0.0, 0}, {-0.0, 0, -0.0}, {0, 0, next}, {0, 0, -next}, {0, 0, 0}};
  const WeldResult result = weld(positions);
  CHECK(result.first == Indices{0, 0, 2, 3, 0});
  CHECK(result.merged == 2);
}

TEST_CASE("weld: coordinates are not interchangeable") {
  const std::vector<Vec3> positions{{1, 2, 3}, {2, 1, 3}, {3, 2, 1},
                                    {1, 3, 2}, {2, 3, 1}, {3, 1, 2}};
  CHECK(weld(positions).merged == 0);
}

TEST_CASE("weld: a million vertices that are not numbers take no longer than others") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<Vec3> positions(1'000'000, Vec3{nan, 0, 0});
  positions.push_back({inf, 0, 0});
  positions.push_back({-inf, 0, 0});
  const WeldResult result = weld(positions);
  CHECK(result.merged == 999'999);
  CHECK(result.first[999'999] == 0);
  CHECK(result.first[1'000'000] == 1'000'000);
  CHECK(result.first[1'000'001] == 1'000'001);
}

TEST_CASE("weld: vertices in line along an axis do not pile up in the table") {
  // With 300,000 of them in one chain this would take minutes.
  for (const Vec3& step : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 1, 1}}) {
    std::vector<Vec3> positions;
    for (int i = 0; i < 300'000; ++i) positions.push_back(step * (1024.0 * i));
    CHECK(weld(positions).merged == 0);
  }
}

TEST_CASE("weld: agrees with the comparison of all pairs") {
  std::mt19937 random(7);
  for (const std::uint32_t range : {1U, 3U, 8U, 100U}) {
    std::vector<Vec3> positions;
    for (int i = 0; i < 700; ++i) {
      // Powers of two apart differ in their exponents only, negative ones in their sign only.
      const auto coordinate = [&] {
        const auto x = static_cast<double>(random() % range);
        return random() % 2 == 0 ? -x : x * 0x1p40;
      };
      positions.push_back({coordinate(), coordinate(), coordinate()});
    }
    const WeldResult result = weld(positions), expected = weld_slowly(positions);
    CHECK(result.first == expected.first);
    CHECK(result.merged == expected.merged);
  }
}

TEST_CASE("weld: a soup of triangles becomes the mesh that it was made of") {
  const Mesh mesh = test::torus(40, 30);
  std::vector<Vec3> soup;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) soup.push_back(mesh.positions[v]);
  }
  const WeldResult result = weld(soup);
  CHECK(soup.size() - result.merged == mesh.positions.size());
  for (std::size_t i = 0; i < soup.size(); ++i) {
    REQUIRE(result.first[i] <= i);
    REQUIRE(result.first[result.first[i]] == result.first[i]);
    REQUIRE(soup[result.first[i]] == soup[i]);
  }
}
