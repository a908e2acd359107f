// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/simplify/sheet_pairs.hpp"
#include "geometry/simplify/vertex_flags.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// A wavy sheet of n x n cells, and the same sheet 0.01 below it, facing down. The last rows of
/// the lower sheet may be left out.
Mesh wavy_wall(std::uint32_t n, std::uint32_t rows_left_out = 0) {
  Mesh wall = test::grid(n, n);
  for (Vec3& p : wall.positions) p.z = std::sin(0.7 * p.x) * std::cos(0.6 * p.y);
  const Mesh upper = wall;
  const auto first = static_cast<std::uint32_t>(upper.positions.size());
  const double end = static_cast<double>(n - rows_left_out) + 0.5;
  for (const Vec3& p : upper.positions) wall.positions.push_back(p - Vec3{0, 0, 0.01});
  for (const auto& [a, b, c] : upper.triangles) {
    const double far = std::max({upper.positions[a].y, upper.positions[b].y, upper.positions[c].y});
    if (far < end) wall.triangles.push_back({a + first, c + first, b + first});
  }
  return wall;
}

std::optional<SheetPairs> pairs_of(const Mesh& mesh, const SheetPairs::Wall& wall) {
  const std::vector<std::uint8_t> flags(mesh.positions.size(), k_thin);
  return SheetPairs::find(mesh, flags, wall);
}

/// The triangles as their corners' positions, sorted.
std::vector<std::array<std::array<double, 3>, 3>> shape_of(const Mesh& mesh) {
  std::vector<std::array<std::array<double, 3>, 3>> shape;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::array<double, 3>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = mesh.positions[t[i]];
      corners[i] = {p.x, p.y, std::round(p.z * 1e9)};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    shape.push_back(corners);
  }
  std::sort(shape.begin(), shape.end());
  return shape;
}

}  // namespace

TEST_CASE("sheet pairs: one sheet stands for two") {
  const Mesh wall = wavy_wall(20);
  std::optional<SheetPairs> pairs = pairs_of(wall, {.reach = 0.1});
  REQUIRE(pairs);
  CHECK(pairs->locked() == 0);
  const Mesh single = pairs->take_single();
  CHECK(single.triangles.size() == 800);
  CHECK(single.positions.size() == 441);
  CHECK(single.columns.empty());
  CHECK(pairs->triangles_of(single) == 1600);
  const Mesh both = pairs->both(single);
  CHECK(both.positions.size() == wall.positions.size());
  CHECK(shape_of(both) == shape_of(wall));
}

TEST_CASE("sheet pairs: where a sheet ends its vertices are held") {
  const Mesh wall = wavy_wall(20, 4);
  CHECK(!pairs_of(wall, {.reach = 0.1, .most_held_up = 41}));
  std::optional<SheetPairs> pairs = pairs_of(wall, {.reach = 0.1, .most_held_up = 42});
  REQUIRE(pairs);
  CHECK(pairs->locked() == 42);
  const Mesh single = pairs->take_single();
  CHECK(single.triangles.size() == 800);
  CHECK(std::count(single.columns.labels.begin(), single.columns.labels.end(), 1U) == 640);
  CHECK(pairs->triangles_of(single) == wall.triangles.size());
  CHECK(shape_of(pairs->both(single)) == shape_of(wall));
}

TEST_CASE("sheet pairs: locked vertices keep their places") {
  const Mesh wall = wavy_wall(20);
  std::optional<SheetPairs> pairs = pairs_of(wall, {.locked = 30, .reach = 0.1});
  REQUIRE(pairs);
  CHECK(pairs->locked() == 60);
  const Mesh both = pairs->both(pairs->take_single());
  for (std::size_t v = 0; v < 30; ++v) CHECK(both.positions[v] == wall.positions[v]);
  CHECK(shape_of(both) == shape_of(wall));
}

TEST_CASE("sheet pairs: there are none beyond the reach, or of other triangles") {
  CHECK(!pairs_of(wavy_wall(20), {.reach = 0.009}));
  CHECK(!pairs_of(wavy_wall(20, 16), {.reach = 0.1, .most_held_up = 1000}));
  Mesh other = wavy_wall(20);
  for (std::size_t v = 441; v < other.positions.size(); ++v) other.positions[v].x += 0.5;
  CHECK(!pairs_of(other, {.reach = 1}));
  CHECK(!pairs_of(test::grid(20, 20), {.reach = 0.1}));
}
