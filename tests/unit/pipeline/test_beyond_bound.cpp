// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include "pipeline/beyond_bound.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// A triangle above the plane z = 0, whose middle is at the height.
Mesh roof(double height) {
  return {{{0, 0, height}, {3, 0, height}, {0, 3, height}}, {{0, 1, 2}}};
}

Mesh large_plane() {
  return {{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace

TEST_CASE("what is beyond a bound: triangles of which a corner or a middle is") {
  CHECK(part_beyond(roof(0.9), PointsInside::some, large_plane(), 1, 1).triangles.empty());
  CHECK(part_beyond(roof(1.1), PointsInside::none, large_plane(), 1, 1).triangles.size() >= 1);
  Mesh far_corner = roof(0.9);
  far_corner.positions[2].z = 1.1;
  CHECK(part_beyond(far_corner, PointsInside::none, large_plane(), 1, 1).triangles.size() == 1);
}

TEST_CASE("what is beyond a bound: points inside are looked at where that is asked for") {
  // A pit below the middle of a triangle, whose sides are all near the rest.
  Mesh pit = test::grid(6, 6);
  for (Vec3& p : pit.positions) p.z = p.x == 2 && p.y == 2 ? -3 : 0;
  std::erase_if(pit.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return pit.positions[v].z < 0; });
  });
  const Mesh lid = {{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}, {{0, 1, 2}}};
  CHECK(part_beyond(lid, PointsInside::none, pit, 0.3, 1).triangles.empty());
  CHECK_FALSE(part_beyond(lid, PointsInside::some, pit, 0.3, 1).triangles.empty());
}

TEST_CASE("what is beyond a bound: what has no area is no surface, and nothing is near nothing") {
  Mesh needle = roof(0.5);
  needle.positions.push_back({0, 0, 8});
  needle.triangles.push_back({0, 3, 0});
  CHECK(part_beyond(needle, PointsInside::none, large_plane(), 1, 1).triangles.empty());
  CHECK(part_beyond(needle, PointsInside::none, {}, 1, 1).triangles.empty());
}

TEST_CASE("flags are cleared near a surface only") {
  const Mesh plane = test::grid(40, 40);
  const Mesh spot = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  std::vector<std::uint8_t> flags(plane.positions.size(), 1);
  clear_near({}, 2, plane.positions, flags);
  CHECK(std::count(flags.begin(), flags.end(), 0) == 0);
  clear_near(spot, 2, plane.positions, flags);
  for (std::size_t v = 0; v < flags.size(); ++v) {
    const Vec3 p = plane.positions[v];
    if (p.x <= 3 && p.y <= 3) CHECK(flags[v] == 0);
    if (p.x >= 5 || p.y >= 5) CHECK(flags[v] == 1);
  }
}
