// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify_within.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// Vertices of the input that are too far from the result.
FindStrays vertices_beyond(const Mesh& input, double bound) {
  return [&input, bound](const Mesh& mesh) -> std::optional<std::vector<Vec3>> {
    return DistanceMeter(mesh, 1).beyond(input.positions, bound);
  };
}

/// A wave of long sides, and one needle of a single vertex.
Mesh sheet_with_a_needle() {
  Mesh mesh = test::grid(80, 80);
  for (Vec3& p : mesh.positions) p.z = 2 * std::sin(p.x * 0.1);
  mesh.positions[40 * 81 + 40].z += 3;
  return mesh;
}

}  // namespace

TEST_CASE("a bound that cost does not know is kept, and one bad place does not end the work") {
  const Mesh mesh = sheet_with_a_needle();
  for (const double bound : {0.05, 0.5}) {
    BoundedSimplifier simplifier(mesh, {}, vertices_beyond(mesh, bound));
    CHECK(reduce_to_bound(simplifier, 2) > 0);
    CHECK(DistanceMeter(simplifier.mesh(), 1).measure(mesh.positions).max <= bound);
    CHECK(simplifier.triangles() < mesh.triangles.size() / 20);
    CHECK(measure_topology(simplifier.mesh()).euler == 1);
  }
}

TEST_CASE("locked vertices stay the first, in their order, when others are locked beside them") {
  const Mesh mesh = sheet_with_a_needle();
  BoundedSimplifier simplifier(mesh, {.locked_vertices = 100}, vertices_beyond(mesh, 0.05));
  reduce_to_bound(simplifier, 2);
  CHECK(simplifier.triangles() < mesh.triangles.size() / 4);
  for (std::size_t v = 0; v < 100; ++v) {
    REQUIRE(simplifier.mesh().positions[v] == mesh.positions[v]);
  }
}

TEST_CASE("places that are bad from the start stay as they are and do not end the work") {
  const Mesh mesh = sheet_with_a_needle();
  Mesh without = mesh;
  without.positions[40 * 81 + 40].z -= 3;
  BoundedSimplifier strict(without, {}, vertices_beyond(mesh, 0.05));
  reduce_to_bound(strict, 2);
  CHECK(strict.triangles() == mesh.triangles.size());
  BoundedSimplifier simplifier(without, {}, vertices_beyond(mesh, 0.05));
  REQUIRE(simplifier.accept_strays());
  reduce_to_bound(simplifier, 2);
  CHECK(simplifier.triangles() < mesh.triangles.size() / 4);
  CHECK(DistanceMeter(simplifier.mesh(), 1).beyond(mesh.positions, 0.05).size() == 1);
}

TEST_CASE("too many bad places: nothing is done") {
  const Mesh mesh = test::icosphere(4);
  BoundedSimplifier simplifier(mesh, {}, [](const Mesh&) { return std::nullopt; });
  reduce_to_bound(simplifier, 2);
  CHECK(simplifier.mesh().triangles == mesh.triangles);
}
