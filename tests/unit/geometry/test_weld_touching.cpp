// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <span>

#include <doctest/doctest.h>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/weld.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

struct Welded {
  WeldResult result;
  Topology topology;
};

/// A mesh's weld, and the topology of the welded mesh without the triangles that lost a corner.
Welded weld_mesh(Mesh mesh, std::span<const std::uint32_t> open = {}) {
  Welded welded{weld(mesh.positions), {}};
  separate_touching(mesh.triangles, open, welded.result);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = welded.result.first[v];
  }
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  welded.topology = measure_topology(mesh);
  return welded;
}

bool is_closed_manifold(const Topology& t) {
  return t.border_edges + t.nonmanifold_edges + t.orientation_conflicts + t.duplicate == 0;
}

}  // namespace

TEST_CASE("touching surfaces stay apart at a point") {
  const Mesh octahedron = test::octahedron();
  const Welded welded = weld_mesh(test::touching_twice(octahedron, octahedron.positions[0]));
  CHECK(welded.result.merged == 0);
  CHECK(welded.topology.components == 2);
}

TEST_CASE("touching surfaces stay apart along an edge") {
  const Mesh octahedron = test::octahedron();
  const Triangle& t = octahedron.triangles[0];
  const Vec3 middle = (octahedron.positions[t[0]] + octahedron.positions[t[1]]) * 0.5;
  const Mesh both = test::touching_twice(octahedron, middle);
  REQUIRE(weld(both.positions).merged == 2);
  const Welded welded = weld_mesh(both);
  CHECK(welded.result.merged == 0);
  CHECK(welded.topology.components == 2);
  CHECK(is_closed_manifold(welded.topology));
}

TEST_CASE("a vertex with triangles elsewhere stays merged") {
  const Mesh octahedron = test::octahedron();
  const std::uint32_t twin = 6;
  const Welded welded =
      weld_mesh(test::touching_twice(octahedron, octahedron.positions[0]), {{twin}});
  CHECK(welded.result.merged == 1);
  CHECK(welded.result.first[twin] == 0);
}

TEST_CASE("copies of a surface become one") {
  Mesh copies = test::octahedron();
  test::append(copies, test::octahedron());
  test::append(copies, test::octahedron());
  CHECK(weld_mesh(copies).result.merged == 12);
}

TEST_CASE("open seams are welded") {
  const Mesh torus = test::torus(12, 8);
  Mesh soup;
  for (const Triangle& t : torus.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(torus.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const Welded welded = weld_mesh(soup);
  CHECK(welded.topology.used_vertices == torus.positions.size());
  CHECK(is_closed_manifold(welded.topology));
}

TEST_CASE("an edge of no length is welded, a neck of no width is not tied off") {
  const std::uint32_t rows = 12;
  const std::uint32_t columns = 5;
  Mesh edge = test::torus(rows, columns);
  edge.positions[edge.triangles[0][1]] = edge.positions[edge.triangles[0][0]];
  const Welded shorter = weld_mesh(edge);
  CHECK(shorter.result.merged == 1);
  CHECK(shorter.topology.euler == 0);
  CHECK(is_closed_manifold(shorter.topology));

  Mesh neck = test::torus(rows, columns);
  for (std::uint32_t i = 1; i < columns; ++i) neck.positions[i] = neck.positions[0];
  REQUIRE(weld(neck.positions).merged == columns - 1);
  const Welded whole = weld_mesh(neck);
  CHECK(whole.result.merged == 0);
  CHECK(whole.topology.euler == 0);
  CHECK(is_closed_manifold(whole.topology));
}

TEST_CASE("a surface of no size vanishes") {
  Mesh point = test::octahedron();
  std::fill(point.positions.begin(), point.positions.end(), Vec3{1, 2, 3});
  test::append(point, test::tetrahedron());
  const Welded welded = weld_mesh(point);
  CHECK(welded.result.merged == 5);
  CHECK(welded.topology.components == 1);
}
