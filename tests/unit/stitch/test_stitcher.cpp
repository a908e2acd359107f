// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

namespace {

/// Two halves of a strip; 0 and 1 of each are boundary vertices, and two boundary triangles join
/// them:
///
///     A2---A0 - - B0---B2
///     |  / |   /  |  / |
///     A3---A1 - - B1---B3
ResultMesh half(double x0, double direction) {
  ResultMesh part;
  part.mesh.positions = {{x0, 1, 0}, {x0, 0, 0}, {x0 + direction, 1, 0}, {x0 + direction, 0, 0}};
  if (direction < 0) {
    part.mesh.triangles = {{2, 3, 0}, {3, 1, 0}};
  } else {
    part.mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  }
  part.boundary_vertices = 2;
  return part;
}

}  // namespace

TEST_CASE("parts and boundary triangles become one mesh") {
  Stitcher stitcher(2);
  stitcher.add(half(0, -1));
  stitcher.add(half(1, 1));
  const std::vector<BoundaryTriangle> boundary = {{{{0, 0}, {0, 1}, {1, 0}}},
                                                  {{{0, 1}, {1, 1}, {1, 0}}}};
  const StitchedMesh stitched = stitcher.finish(boundary);
  CHECK(stitched.mesh.triangles.size() == 6);
  CHECK(stitched.seam == std::vector<std::uint8_t>{1, 1, 0, 0, 1, 1, 0, 0});
  CHECK(stitched.mesh.positions[4] == Vec3{1, 1, 0});
  const Topology topology = measure_topology(stitched.mesh);
  CHECK(topology.components == 1);
  CHECK(topology.border_edges == 8);
  CHECK(topology.nonmanifold_edges == 0);
  CHECK(topology.orientation_conflicts == 0);
  CHECK(topology.euler == 1);
}

TEST_CASE("opened vertices are numbered on from part to part") {
  ResultMesh left = half(0, -1);
  ResultMesh right = half(1, 1);
  left.opened = {2};
  right.opened = {2, 3};
  Stitcher stitcher(2);
  stitcher.add(left);
  stitcher.add(right);
  CHECK(stitcher.finish({}).opened == std::vector<std::uint32_t>{2, 6, 7});
}

TEST_CASE("labels are stitched in the order of their triangles") {
  ResultMesh left = half(0, -1);
  ResultMesh right = half(1, 1);
  left.mesh.columns.labels = {1, 2};
  right.mesh.columns.labels = {3, 4};
  Stitcher stitcher(2);
  stitcher.add(left);
  stitcher.add(right);
  const std::vector<BoundaryTriangle> boundary = {{{{0, 0}, {0, 1}, {1, 0}}},
                                                  {{{0, 1}, {1, 1}, {1, 0}}}};
  const std::vector<Label> labels = {5, 6};
  CHECK(stitcher.finish(boundary, {labels, {}}).mesh.columns.labels ==
        std::vector<Label>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("a corner that names no boundary vertex is refused with its place") {
  Stitcher stitcher(2);
  stitcher.add(half(0, -1));
  stitcher.add(half(1, 1));
  const std::vector<BoundaryTriangle> inner = {{{{0, 0}, {0, 1}, {1, 2}}}};
  CHECK_THROWS_WITH_AS(stitcher.finish(inner),
                       "a boundary triangle names vertex 2 of part 1, which is no boundary vertex "
                       "there; cut the mesh again",
                       DataError);
  Stitcher other(1);
  other.add(half(0, -1));
  const std::vector<BoundaryTriangle> absent = {{{{0, 0}, {0, 1}, {1, 0}}}};
  CHECK_THROWS_AS(other.finish(absent), DataError);
}

namespace {

/// A strip of squares as parts of one square each, in a row: part p is half(2 p, 1), its boundary
/// vertices the four corners.
///
///     0---2 - - 0---2 - - 0---2 - ...
///     |  /|   / |  /|   / |  /|
///     1---3 - - 1---3 - - 1---3 - ...
ResultMesh square(double x0) {
  ResultMesh part = half(x0, 1);
  part.boundary_vertices = 4;
  return part;
}

std::vector<BoundaryTriangle> seams(std::uint32_t parts) {
  std::vector<BoundaryTriangle> all;
  for (std::uint32_t p = 0; p + 1 < parts; ++p) {
    all.push_back({{{p, 2}, {p, 3}, {p + 1, 0}}});
    all.push_back({{{p, 3}, {p + 1, 1}, {p + 1, 0}}});
  }
  return all;
}

/// The result of a composition of the stitched mesh, without simplification: open vertices first.
ResultMesh composed(const StitchedMesh& stitched) {
  ResultMesh result;
  const std::size_t vertices = stitched.mesh.positions.size();
  std::vector<std::uint32_t> order = stitched.open;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (std::count(order.begin(), order.end(), v) == 0) order.push_back(v);
  }
  std::vector<std::uint32_t> number(vertices);
  for (std::uint32_t i = 0; i < vertices; ++i) number[order[i]] = i;
  for (const std::uint32_t v : order) result.mesh.positions.push_back(stitched.mesh.positions[v]);
  for (const Triangle& t : stitched.mesh.triangles) {
    result.mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  result.boundary_vertices = static_cast<std::uint32_t>(stitched.open.size());
  return result;
}

}  // namespace

TEST_CASE("neighbours are composed, and what they make is composed again") {
  const std::vector<BoundaryTriangle> boundary = seams(5);
  Stitcher middle(5, 1);
  middle.add(square(2));
  middle.add(square(4));
  const StitchedMesh two = middle.finish(boundary);
  CHECK(two.boundary_triangles == 2);
  CHECK(two.open == std::vector<std::uint32_t>{0, 1, 6, 7});  // (1, 0) (1, 1) (2, 2) (2, 3)

  Stitcher more(5, 1);
  more.add(composed(two), 2);
  more.add(square(6));
  const StitchedMesh three = more.finish(boundary);
  CHECK(three.boundary_triangles == 2);
  CHECK(three.mesh.triangles.size() == 3 * 2 + 2 * 2);
  REQUIRE(three.open.size() == 4);
  CHECK(three.mesh.positions[three.open[3]] == Vec3{7, 0, 0});

  Stitcher all(5);
  all.add(square(0));
  all.add(composed(three), 3);
  all.add(square(8));
  const StitchedMesh whole = all.finish(boundary);
  CHECK(whole.open.empty());
  CHECK(whole.mesh.triangles.size() == 5 * 2 + 4 * 2);
  const Topology topology = measure_topology(whole.mesh);
  CHECK(topology.components == 1);
  CHECK(topology.euler == 1);
  CHECK(topology.border_edges == 20);
  CHECK(topology.nonmanifold_edges + topology.orientation_conflicts == 0);
}

TEST_CASE("a composed result that is not of these parts is refused") {
  Stitcher stitcher(5, 1);
  ResultMesh wrong = square(2);
  wrong.boundary_vertices = 3;
  stitcher.add(wrong, 2);
  CHECK_THROWS_WITH_AS(stitcher.finish(seams(5)),
                       "a composed result has 3 boundary vertices where the boundary triangles "
                       "tell of 4",
                       DataError);
}

TEST_CASE("appearances are joined, and those of a part without any are black") {
  Stitcher stitcher(3);
  ResultMesh coloured = half(0, -1);
  coloured.mesh.appearances = {{1}, {2}, {3}, {4}};
  stitcher.add(half(1, 1));
  stitcher.add(coloured);
  stitcher.add(ResultMesh{});
  const StitchedMesh stitched = stitcher.finish({});
  const std::vector<Appearance> expected = {{}, {}, {}, {}, {1}, {2}, {3}, {4}};
  CHECK(stitched.mesh.appearances == expected);
}
