// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

void add(Mesh& mesh, Mesh piece, double size, Vec3 at) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : piece.positions) mesh.positions.push_back(p * size + at);
  for (const auto& [a, b, c] : piece.triangles) {
    mesh.triangles.push_back({a + first, b + first, c + first});
  }
}

}  // namespace

TEST_CASE("pieces below the diagonal go, whatever their number of triangles") {
  Mesh mesh;
  add(mesh, test::icosphere(3), 0.01, {5, 0, 0});  // small, of many triangles
  add(mesh, test::tetrahedron(), 2, {0, 0, 0});    // large, of few
  add(mesh, test::tetrahedron(), 0.01, {0, 5, 0});
  const DroppedComponents dropped = drop_small_components(mesh, 0.1);
  CHECK(dropped.components == 2);
  CHECK(dropped.triangles == 1280 + 4);
  CHECK(mesh.triangles.size() == 4);
  CHECK(measure_topology(mesh).components == 1);
  CHECK(drop_small_components(mesh, 0.1).components == 0);
}

TEST_CASE("a piece of just that diagonal stays, and a touching vertex joins pieces") {
  Mesh tie = test::bow_tie();  // two triangles of diagonal sqrt(5), together 2 x 2
  CHECK(drop_small_components(tie, std::sqrt(8.0)).components == 0);
  CHECK(drop_small_components(tie, std::sqrt(8.0) * 1.0001).triangles == 2);
  CHECK(drop_small_components(tie, 0).triangles == 0);
  Mesh nothing;
  CHECK(drop_small_components(nothing, 1).components == 0);
}

TEST_CASE("pieces that nothing is left of are told by number and area") {
  Mesh before;
  add(before, test::icosphere(3), 1, {0, 0, 0});
  add(before, test::icosphere(2), 1, {5, 0, 0});
  add(before, test::tetrahedron(), 0.1, {0, 5, 0});
  Mesh after;
  add(after, test::icosphere(1), 1.05, {0, 0, 0});
  GoneComponents gone = find_gone_components(before, after, 1);
  CHECK(gone.components == 2);
  CHECK(gone.area == doctest::Approx(gone.area_of_all / 2).epsilon(0.05));
  // Two pieces in the place of one count as that one only.
  add(after, test::octahedron(), 1, {0, 0, 0});
  CHECK(find_gone_components(before, after, 1).components == 2);
  add(after, test::tetrahedron(), 0.1, {0, 5.01, 0});
  gone = find_gone_components(before, after, 1);
  CHECK(gone.components == 1);
  CHECK(find_gone_components(before, before, 1).components == 0);
  CHECK(find_gone_components(before, {}, 1).components == 3);
}

TEST_CASE("a floor is found, though all that is left of its vertices is at the feet of boxes") {
  constexpr std::uint32_t k_size = 40;
  Mesh before;
  Mesh after;
  add(before, test::grid(k_size, k_size), 1, {});
  Mesh floor = test::grid(k_size / 4, k_size / 4);
  for (Vec3& p : floor.positions) p = p * 4.0 + Vec3{0, 0, 0.4};
  add(after, floor, 1, {});
  for (std::uint32_t x = 0; x <= k_size; x += 4) {
    for (std::uint32_t y = 0; y <= k_size; y += 4) {
      add(before, test::octahedron(), 0.5, {1.0 * x, 1.0 * y, 0.6});
    }
  }
  const GoneComponents gone = find_gone_components(before, after, 1);
  CHECK(gone.components == 121);
  CHECK(gone.area < 0.2 * gone.area_of_all);
}

TEST_CASE(
    "a wall between two skins is found, though all that is left of its rims is nearer to these") {
  const auto wall = [](double low, double high, std::uint32_t steps) {
    Mesh mesh = test::grid(steps, 1);
    for (Vec3& p : mesh.positions) p = {1 + 7.0 * p.x / steps, 4, p.y > 0 ? high : low};
    return mesh;
  };
  Mesh after;
  for (const double z : {0, 2}) add(after, test::grid(1, 1), 9, {0, 0, z});
  Mesh before = after;
  add(before, wall(0.02, 1.98, 70), 1, {});
  GoneComponents gone = find_gone_components(before, after, 1);
  CHECK(gone.components == 1);
  CHECK(gone.area == doctest::Approx(7 * 1.96));
  add(after, wall(0, 2, 3), 1, {});
  CHECK(find_gone_components(before, after, 1).components == 0);
}
