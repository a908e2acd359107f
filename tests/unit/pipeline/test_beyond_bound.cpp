// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/triangle_index.hpp>
#include <meshfarm/geometry/vertices.hpp>

#include "pipeline/beyond_bound.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// A triangle at `height` above the plane z = 0.
Mesh roof(double height) {
  return {{{0, 0, height}, {3, 0, height}, {0, 3, height}}, {{0, 1, 2}}};
}

Mesh large_plane() {
  return {{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace

TEST_CASE("what is beyond a bound: triangles of which any point is") {
  const Mesh plane = large_plane();
  const TriangleIndex index(plane, 1);
  CHECK(part_beyond(roof(0.9), index, 1, 1).triangles.empty());
  CHECK(part_beyond(roof(1.1), index, 1, 1).triangles.size() == 1);
  Mesh far_corner = roof(0.9);
  far_corner.positions[2].z = 1.1;
  CHECK(part_beyond(far_corner, index, 1, 1).triangles.size() == 1);
}

TEST_CASE("what is beyond a bound: the pieces of a large triangle that are, and no others") {
  // A pit below the middle of a triangle, whose sides are all near the rest.
  Mesh pit = test::grid(6, 6);
  for (Vec3& p : pit.positions) p.z = p.x == 2 && p.y == 2 ? -3 : 0;
  std::erase_if(pit.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return pit.positions[v].z < 0; });
  });
  const TriangleIndex index(pit, 1);
  const Mesh lid = {{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, {{0, 1, 2}}};
  CHECK(part_beyond(lid, index, 0.3, 1).triangles.size() == 1);
  AstrayFinder finder(index, 0.3, 1);
  const Mesh pieces = finder.find(lid);
  CHECK(pieces.triangles.size() > 4);
  for (const Triangle& t : pieces.triangles) {
    for (const std::uint32_t v : t) {
      CHECK(std::abs(pieces.positions[v].x - 2) < 1);
      CHECK(std::abs(pieces.positions[v].y - 2) < 1);
    }
  }
  const Mesh plane = large_plane();
  const TriangleIndex flat(plane, 1);
  CHECK(AstrayFinder(flat, 0.3, 1).find(roof(0)).triangles.empty());
}

TEST_CASE("what went astray is found again in what was made once more") {
  const Mesh plane = large_plane();
  const TriangleIndex index(plane, 1);
  AstrayFinder finder(index, 1, 1);
  Mesh made = roof(0.5);
  CHECK(finder.find(made).triangles.empty());
  append_surface(roof(2).positions, roof(2).triangles, made);
  const std::size_t far = finder.find(made).triangles.size();
  CHECK(far > 0);
  CHECK(finder.find(made).triangles.size() == far);
  std::swap(made.positions[0], made.positions[1]);  // other numbers, the same places
  CHECK(finder.find(made).triangles.size() == far);
  CHECK(finder.find(roof(0.5)).triangles.empty());
}

TEST_CASE("what is known is passed over, however far it is") {
  const Mesh plane = large_plane();
  const TriangleIndex index(plane, 1);
  AstrayFinder finder(index, 1, 1);
  finder.pass_over(roof(2));
  CHECK(finder.find(roof(2)).triangles.empty());
  CHECK_FALSE(finder.find(roof(3)).triangles.empty());
}

TEST_CASE("what is beyond a bound: what has no area is no surface") {
  Mesh needle = roof(0.5);
  needle.positions.push_back({0, 0, 8});
  needle.triangles.push_back({0, 3, 0});
  const Mesh plane = large_plane();
  CHECK(part_beyond(needle, TriangleIndex(plane, 1), 1, 1).triangles.empty());
  CHECK(part_beyond({}, TriangleIndex(plane, 1), 1, 1).triangles.empty());
}

TEST_CASE("flags are cleared near a surface only") {
  const Mesh plane = test::grid(40, 40);
  const Mesh spot = {{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {{0, 1, 2}}};
  std::vector<std::uint8_t> flags(plane.positions.size(), 1);
  clear_near({}, 2, plane.positions, flags);
  CHECK(std::count(flags.begin(), flags.end(), 0) == 0);
  clear_near(spot, 2, plane.positions, flags);
  for (std::size_t v = 0; v < flags.size(); ++v) {
    const Vec3 p = plane.positions[v];
    const double along = std::clamp((p.y - p.x + 8) / 2, 0.0, 8.0);
    const double beside = std::hypot(p.x - (8 - along), p.y - along);
    CHECK(flags[v] == (p.x + p.y <= 8 || beside <= 2 ? 0 : 1));
  }
}

TEST_CASE("flags are cleared near a slanted triangle, not in its box") {
  const Mesh plane = test::grid(40, 40);
  const Mesh strip = {{{0, 0, 0}, {40, 40, 0}, {40, 39, 0}}, {{0, 1, 2}}};
  std::vector<std::uint8_t> flags(plane.positions.size(), 1);
  clear_near(strip, 1, plane.positions, flags);
  for (std::size_t v = 0; v < flags.size(); ++v) {
    const Vec3 p = plane.positions[v];
    if (p.x == p.y) CHECK(flags[v] == 0);
    if (std::abs(p.x - p.y) > 3) CHECK(flags[v] == 1);
  }
}

TEST_CASE("flags are cleared of the corners of large triangles that come near") {
  const Mesh spot = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Mesh mesh = large_plane();
  append_surface(std::vector<Vec3>{{50, 0, 0}, {51, 0, 0}, {50, 1, 0}},
                 std::vector<Triangle>{{0, 1, 2}}, mesh);
  std::vector<std::uint8_t> flags(mesh.positions.size(), 1);
  clear_touched({}, 1, mesh, flags);
  CHECK(std::count(flags.begin(), flags.end(), 0) == 0);
  clear_touched(spot, 1, mesh, flags);
  CHECK(std::count(flags.begin(), flags.begin() + 4, 0) == 4);
  CHECK(std::count(flags.begin() + 4, flags.end(), 1) == 3);
}
