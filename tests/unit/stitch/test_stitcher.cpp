// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
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
  Stitcher stitcher;
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

TEST_CASE("a corner that names no boundary vertex is refused with its place") {
  Stitcher stitcher;
  stitcher.add(half(0, -1));
  stitcher.add(half(1, 1));
  const std::vector<BoundaryTriangle> inner = {{{{0, 0}, {0, 1}, {1, 2}}}};
  CHECK_THROWS_WITH_AS(stitcher.finish(inner),
                       "a boundary triangle names vertex 2 of part 1, which is no boundary vertex "
                       "there; cut the mesh again",
                       DataError);
  Stitcher other;
  other.add(half(0, -1));
  const std::vector<BoundaryTriangle> absent = {{{{0, 0}, {0, 1}, {1, 0}}}};
  CHECK_THROWS_AS(other.finish(absent), DataError);
}
