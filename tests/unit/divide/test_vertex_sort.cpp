// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <random>

#include <doctest/doctest.h>

#include "divide/vertex_sort.hpp"

using namespace meshfarm;

namespace {

/// Few different coordinates, of both signs and both zeros: many ties in one, two and three axes.
std::vector<Vec3> points(std::size_t count, PositionType type) {
  std::mt19937 random(11);
  const std::vector<double> values = {-3.5, -1e-30, -0.0, 0.0, 1e-30, 0.1, 2, 1e20};
  std::vector<Vec3> made;
  for (std::size_t i = 0; i < count; ++i) {
    const auto any = [&] { return values[random() % values.size()] + (i % 3 == 0 ? 1.0 / 3 : 0); };
    made.push_back(rounded({any(), any(), any()}, type));
  }
  return made;
}

}  // namespace

TEST_CASE("vertices are sorted as a plain comparison would, along any axis and either way") {
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    const std::vector<Vec3> positions = points(5000, type);
    for (const std::array<int, 3> axes :
         {std::array{0, 1, 2}, std::array{1, 0, 2}, std::array{2, 0, 1}}) {
      for (const double sign : {1.0, -1.0}) {
        const SweepOrder order{axes, sign};
        std::vector<std::uint32_t> expected(positions.size());
        std::iota(expected.begin(), expected.end(), 0U);
        std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
          return order.before(positions[a], positions[b]);
        });
        CHECK(sorted_vertices(positions, order, type) == expected);
      }
    }
  }
}

TEST_CASE("what is in order is left as it is") {
  std::vector<Vec3> positions = points(500, PositionType::float64);
  const SweepOrder order;
  std::sort(positions.begin(), positions.end(), [&](Vec3 a, Vec3 b) { return order.before(a, b); });
  CHECK(sorted_vertices(positions, order, PositionType::float64).empty());
  CHECK(sorted_vertices({}, order, PositionType::float32).empty());
}
