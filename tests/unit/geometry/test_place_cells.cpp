// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/simplify/place_cells.hpp"

using namespace meshfarm;

TEST_CASE("place cells: the nearest that counts, no farther than asked for") {
  std::mt19937 random(3);
  const auto place = [&] {
    const auto unit = [&] { return static_cast<double>(random()) / 0x1p32; };
    return Vec3{unit(), 4 * unit(), unit()};
  };
  std::vector<Vec3> points(1000);
  for (Vec3& p : points) p = place();
  points[7] = points[3];
  const auto is_odd = [](std::uint32_t point) { return point % 2 == 1; };
  for (const double reach : {0.03, 0.3, 5.0}) {
    for (const double spacing : {0.0, 0.01, 1.0}) {
      const PlaceCells cells(points, reach, spacing);
      for (std::size_t i = 0; i < 200; ++i) {
        const Vec3 from = i < 8 ? points[i] : place() * 1.2;
        std::optional<std::uint32_t> nearest;
        for (std::uint32_t p = 1; p < points.size(); p += 2) {
          const double squared = squared_length(points[p] - from);
          if (squared > reach * reach) continue;
          if (!nearest || squared < squared_length(points[*nearest] - from)) nearest = p;
        }
        REQUIRE(cells.nearest(from, is_odd) == nearest);
      }
    }
  }
  CHECK_FALSE(PlaceCells({}, 1, 0.1).nearest({}, is_odd));
  CHECK_FALSE(PlaceCells(points, 1, 1e-9).nearest({1e300, 0, 0}, is_odd));
}
