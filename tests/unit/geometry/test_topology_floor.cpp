// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "geometry/simplify/topology_floor.hpp"
#include "geometry/simplify/working_mesh.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::uint64_t floor_of(const Mesh& mesh, const SimplifyOptions& options = {}) {
  const WorkingMesh working(mesh, options);
  Adjacency adjacency;
  adjacency.build(working.mesh().triangles, working.vertices());
  return least_triangles(working.flags(), adjacency);
}

/// A ring of squares: an open tube.
Mesh tube(std::uint32_t around, std::uint32_t along) {
  Mesh mesh = test::grid(around, along);
  const std::uint32_t row = around + 1;
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = v % row == around ? v - around : v;
  }
  return mesh;
}

}  // namespace

TEST_CASE("least triangles: four of a closed surface, one of a sheet, six of a tube") {
  CHECK(floor_of(test::tetrahedron()) == 4);
  CHECK(floor_of(test::icosphere(2)) == 4);
  CHECK(floor_of(test::grid(5, 4)) == 1);
  CHECK(floor_of(tube(8, 3)) == 6);
}

TEST_CASE("least triangles: a handle needs four more, a hole five") {
  CHECK(floor_of(test::torus(9, 7)) == 8);
  Mesh with_hole = test::grid(6, 6);
  with_hole.triangles.erase(with_hole.triangles.begin() + 30, with_hole.triangles.begin() + 32);
  REQUIRE(measure_topology(with_hole).euler == 0);
  CHECK(floor_of(with_hole) == 6);
}

TEST_CASE("least triangles: those of all components, one where little is known") {
  Mesh mesh = test::icosphere(1);
  test::append(mesh, test::torus(5, 4));
  test::append(mesh, test::grid(2, 2));
  CHECK(floor_of(mesh) == 4 + 8 + 1);
  CHECK(floor_of(test::icosphere(1), {.locked_vertices = 1}) == 1);
  CHECK(floor_of(tube(8, 3), {.lines = {.preserve_border = true}}) == 1);
  CHECK(floor_of({}) == 0);
}

TEST_CASE("least triangles: what is simplified with its topology kept has no fewer") {
  for (const Mesh& mesh : {test::icosphere(3), test::torus(16, 12), tube(20, 9)}) {
    Simplifier simplifier(mesh, {.lines = {.topology = TopologyMode::keep}});
    simplifier.reduce({.triangles = 1});
    CHECK(simplifier.triangles() >= floor_of(mesh));
    CHECK(simplifier.triangles() <= 3 * floor_of(mesh));
    CHECK(floor_of(simplifier.mesh()) == floor_of(mesh));
  }
}
