// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "divide/part_builder.hpp"
#include "divide/weld_share.hpp"

using namespace meshfarm;

namespace {

/// Two tetrahedra that face outwards, with their fourth corners, 3 and 7, at the same point.
MeshShare tips_that_touch() {
  MeshShare share;
  share.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1},
                     {0, 0, 2}, {0, 2, 2}, {2, 0, 2}, {0, 0, 1}};
  for (const std::uint32_t base : {0U, 4U}) {
    for (const Triangle& t : {Triangle{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
      share.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
  }
  return share;
}

/// Two triangles that share a side, each with vertices of its own: a soup.
MeshShare soup() {
  MeshShare share;
  share.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  share.triangles = {{0, 1, 2}, {3, 4, 5}};
  return share;
}

using ThreePoints = std::array<Vec3, 3>;
ThreePoints corners_of(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

}  // namespace

TEST_CASE("copies of one surface's vertices are welded, and counted") {
  const MeshShare share = soup();
  WeldResult welded = weld(share.positions);
  const WeldCounts counts = keep_apart(share, welded);
  CHECK(counts.coincident_vertices == 2);
  CHECK(counts.coincident_corners == 0);
  CHECK(welded.first == std::vector<std::uint32_t>{0, 1, 2, 2, 1, 5});
}

TEST_CASE("closed surfaces that touch at a point stay apart inside a share") {
  const MeshShare share = tips_that_touch();
  WeldResult welded = weld(share.positions);
  REQUIRE(welded.first[7] == 3);
  CHECK(keep_apart(share, welded).coincident_vertices == 1);
  CHECK(welded.first[7] == 7);
}

TEST_CASE("at the seams of a share it tells itself what stays apart") {
  MeshShare share = tips_that_touch();
  share.boundary = {3, 7};
  WeldResult as_open = weld(share.positions);
  keep_apart(share, as_open);
  CHECK(as_open.first[7] == 3);  // they have triangles elsewhere, and those decide

  share.apart = {{3, 0}, {7, 1}};
  WeldResult as_told = weld(share.positions);
  keep_apart(share, as_told);
  CHECK(as_told.first[3] == 3);
  CHECK(as_told.first[7] == 7);
}

TEST_CASE("a triangle that loses a corner by welding is counted") {
  MeshShare share = soup();
  share.triangles.push_back({2, 3, 5});
  WeldResult welded = weld(share.positions);
  CHECK(keep_apart(share, welded).coincident_corners == 1);
  const BuiltPart built = build_part(share, Weld::exact);
  CHECK(built.dropped_degenerate == 1);
  CHECK(built.part.mesh.triangles.size() == 2);
  CHECK(build_part(share, Weld::off).part.mesh.triangles.size() == 3);
}

TEST_CASE("a part has its boundary vertices first, no unused ones, and the same surface") {
  MeshShare share = soup();
  share.positions.insert(share.positions.begin() + 3, {9, 9, 9});  // no triangle uses it
  for (std::uint32_t& v : share.triangles[1]) ++v;
  share.boundary = {6, 1, 6};
  for (std::uint16_t i = 0; i < 7; ++i) share.appearances.push_back({i, 0, 0, 0});
  share.columns.labels = {4, 8};
  const MeshShare input = share;
  for (const Weld mode : {Weld::exact, Weld::off}) {
    const BuiltPart built = build_part(input, mode);
    const Mesh& mesh = built.part.mesh;
    CHECK(mesh.positions.size() == (mode == Weld::exact ? 4 : 6));
    CHECK(built.part.boundary_vertices == 2);
    CHECK(built.boundary.places == std::vector<std::uint32_t>{1, 6});
    CHECK(built.boundary.numbers == std::vector<std::uint32_t>{0, 1});
    CHECK(mesh.positions[0] == input.positions[1]);
    CHECK(mesh.positions[1] == input.positions[6]);
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.columns.labels == input.columns.labels);
    for (std::size_t t = 0; t < 2; ++t) {
      const Triangle& was = input.triangles[t];
      CHECK(corners_of(mesh, t) ==
            ThreePoints{input.positions[was[0]], input.positions[was[1]], input.positions[was[2]]});
    }
    // Of vertices that became one, the least appearance stays.
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const auto first =
          std::find(input.positions.begin(), input.positions.end(), mesh.positions[v]);
      if (mode == Weld::exact) CHECK(mesh.appearances[v][0] == first - input.positions.begin());
    }
  }
}
