// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/facing_repair.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "geometry/mesh_change.hpp"
#include "geometry/turned.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Vec3 center_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) * (1.0 / 3);
}

/// The triangles that face against the original's triangle nearest to their centre.
std::vector<std::uint32_t> facing_away(const Mesh& mesh, const Mesh& original) {
  const DistanceMeter to_original(original, 1);
  std::vector<std::uint32_t> away;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t nearest = to_original.nearest_triangle(center_of(mesh, i));
    if (dot(normal_of(original, nearest), normal_of(mesh, i)) < 0) away.push_back(i);
  }
  return away;
}

/// Two sheets that face away from each other, the upper one `apart` above the lower one.
Mesh wall(std::uint32_t cells, double apart) {
  Mesh mesh = test::grid(cells, cells);
  const Mesh lower = mesh;
  const auto count = static_cast<std::uint32_t>(lower.positions.size());
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  for (const Vec3& p : lower.positions) mesh.positions.push_back(p + Vec3{0, 0, apart});
  for (const auto& [a, b, c] : lower.triangles) {
    mesh.triangles.push_back({a + count, b + count, c + count});
  }
  return mesh;
}

std::vector<std::uint32_t> all_of(const Mesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

std::uint64_t crossings_of(const Mesh& mesh) {
  return count_crossing_triangles(mesh, {.threads = 1}).value_or(UINT64_MAX);
}

}  // namespace

TEST_CASE("facing: only what has another sheet near it may face the wrong way") {
  const Mesh thin = wall(10, 0.2);
  const TriangleIndex index(thin, 1);
  CHECK(find_opposed_triangles(index, 0.3, 1) == all_of(thin));
  CHECK(find_opposed_triangles(index, 0.1, 2).empty());
  const Mesh sphere = test::icosphere(3);
  CHECK(find_opposed_triangles(TriangleIndex(sphere, 1), 0.5, 2).empty());
}

TEST_CASE("facing: a mesh that faces as the original stays as it is") {
  const Mesh original = wall(12, 0.2);
  Mesh mesh = original;
  FacingRepair repair(mesh, {.reach = 1});
  const FacingMended mended = repair.mend(all_of(mesh), original);
  CHECK(mended.found == 0);
  CHECK(mended.mended == 0);
  CHECK(mesh.positions == original.positions);
  CHECK(mesh.triangles == original.triangles);
  CHECK(repair.mend(all_of(mesh), {}).found == 0);
}

TEST_CASE("facing: vertices that have sunk to the other sheet, and slivers turned over") {
  const Mesh original = wall(24, 0.2);
  std::mt19937 random(11);
  Mesh mesh = wall(12, 0.2);
  for (Vec3& p : mesh.positions) p = {2 * p.x, 2 * p.y, p.z};
  const Mesh even = mesh;
  const auto upper = static_cast<std::uint32_t>(mesh.positions.size() / 2);
  for (std::uint32_t v = upper; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    const bool is_inside = p.x > 0 && p.x < 24 && p.y > 0 && p.y < 24;
    if (is_inside && random() % 3 == 0) p.z = 0.02;
  }
  const std::size_t before = facing_away(mesh, original).size();
  const std::uint64_t crossings = crossings_of(mesh);
  REQUIRE(before > 10);
  SUBCASE("mended") {
    const Topology topology = measure_topology(mesh);
    FacingRepair repair(mesh, {.reach = 1});
    const FacingMended mended = repair.mend(all_of(mesh), original);
    CHECK(mended.found == before);
    CHECK(mended.mended > 0.8 * static_cast<double>(before));
    CHECK(facing_away(mesh, original).size() <= before - mended.mended);
    CHECK(crossings_of(mesh) <= crossings);
    const Topology after = measure_topology(mesh);
    CHECK(after.triangles == topology.triangles);
    CHECK(after.euler == topology.euler);
    CHECK(after.border_edges == topology.border_edges);
    CHECK(after.nonmanifold_edges == 0);
    CHECK(after.orientation_conflicts == 0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = even.positions[v];
      const bool is_border = p.x <= 0 || p.x >= 24 || p.y <= 0 || p.y >= 24;
      if (is_border) CHECK(mesh.positions[v] == p);
    }
  }
  SUBCASE("where nothing may be moved, nothing is but edges") {
    const std::vector<Vec3> positions = mesh.positions;
    FacingRepair repair(mesh, {.reach = 0.01});
    repair.mend(all_of(mesh), original);
    CHECK(mesh.positions == positions);
  }
}

TEST_CASE("facing: a small piece that is narrower than the original's") {
  const Mesh original = test::icosphere(3);
  // Four triangles inside the sphere. One is turned inside out, as a vertex went through the
  // opposite triangle.
  Mesh mesh = test::tetrahedron();
  Vec3 center{};
  for (const Vec3& p : mesh.positions) center = center + p * 0.25;
  for (Vec3& p : mesh.positions) p = (p - center) * 0.9;
  const std::size_t right = facing_away(mesh, original).size();
  CHECK(right == 0);
  mesh.positions[0] = mesh.positions[0] * -0.4;
  const std::size_t before = facing_away(mesh, original).size();
  REQUIRE(before > 0);
  FacingRepair repair(mesh, {.reach = 4});
  const FacingMended mended = repair.mend(all_of(mesh), original);
  CHECK(mended.found == before);
  CHECK(facing_away(mesh, original).size() < before);
}

TEST_CASE("changing mesh: what a change concerns, and what it may not do") {
  Mesh mesh = wall(4, 1);
  const Mesh before = mesh;
  ChangingMesh changing(mesh);
  CHECK(changing.is_inside(12));
  CHECK_FALSE(changing.is_inside(0));
  // The middle of one sheet would go through the other: their triangles would cross.
  const MeshChange through{{{12, mesh.positions[12] + Vec3{0, 0, 1.5}}}, {}};
  const std::vector<std::uint32_t> concerned = changing.concerned_by(through);
  CHECK(concerned.size() == changing.fan(12).size());
  CHECK_FALSE(changing.apply(through, concerned));
  CHECK(mesh.positions == before.positions);
  const MeshChange near{{{12, mesh.positions[12] + Vec3{0, 0, 0.5}}}, {}};
  CHECK(changing.corners_after(concerned[0], near) != changing.corners_of(concerned[0]));
  CHECK(changing.apply(near, concerned));
  CHECK(mesh.positions[12] == before.positions[12] + Vec3{0, 0, 0.5});
}

TEST_CASE("changing mesh: an edge that is flipped is another one's") {
  Mesh mesh = wall(4, 1);
  ChangingMesh changing(mesh);
  const Triangle t = mesh.triangles[10];
  std::size_t edge = 0;
  std::optional<std::uint32_t> other;
  for (; edge < 3 && !other; ++edge) other = changing.beside(t[edge], t[(edge + 1) % 3]);
  REQUIRE(other);
  --edge;
  const std::uint32_t a = t[edge], b = t[(edge + 1) % 3], c = t[(edge + 2) % 3];
  const Triangle u = mesh.triangles[*other];
  const std::uint32_t d =
      *std::find_if(u.begin(), u.end(), [&](std::uint32_t v) { return v != a && v != b; });
  const MeshChange flip{{}, {{10, {c, a, d}}, {*other, {d, b, c}}}};
  REQUIRE(changing.apply(flip, changing.concerned_by(flip)));
  CHECK(changing.beside(c, d).has_value());
  CHECK_FALSE(changing.beside(a, b).has_value());
  const Topology topology = measure_topology(mesh);
  CHECK(topology.orientation_conflicts == 0);
  CHECK(topology.nonmanifold_edges == 0);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    for (const std::uint32_t triangle : changing.fan(v)) {
      const Triangle& at = mesh.triangles[triangle];
      CHECK(std::find(at.begin(), at.end(), v) != at.end());
    }
  }
}
