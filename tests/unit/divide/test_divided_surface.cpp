// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <doctest/doctest.h>

#include <meshfarm/divide/divided_distance.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

void check_same(const Topology& a, const Topology& b) {
  CHECK(a.used_vertices == b.used_vertices);
  CHECK(a.triangles == b.triangles);
  CHECK(a.degenerate == b.degenerate);
  CHECK(a.zero_area == b.zero_area);
  CHECK(a.duplicate == b.duplicate);
  CHECK(a.edges == b.edges);
  CHECK(a.border_edges == b.border_edges);
  CHECK(a.nonmanifold_edges == b.nonmanifold_edges);
  CHECK(a.orientation_conflicts == b.orientation_conflicts);
  CHECK(a.unmatched_edges == b.unmatched_edges);
  CHECK(a.components == b.components);
  CHECK(a.euler == b.euler);
}

/// So few bytes that there are many slabs.
constexpr std::uint64_t k_little = 20'000;

SurfaceTopology measured(const Mesh& mesh, std::uint64_t memory_bytes) {
  const test::TempFolder folder;
  test::MemorySource source(mesh);
  const DividedSurface surface(source, {folder.path(), memory_bytes, 2});
  CHECK(surface.triangles() == mesh.triangles.size());
  return surface.measure_topology();
}

/// Each triangle with vertices of its own.
Mesh soup_of(const Mesh& mesh) {
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

}  // namespace

TEST_CASE("slabs together tell the topology of the whole") {
  Mesh mesh = test::torus(50, 30);
  test::append(mesh, test::grid(20, 20));
  mesh.positions.push_back({9, 9, 9});  // in no triangle
  // Dirt: a triangle twice, one turned over, one degenerate, one too many at an edge.
  mesh.triangles.push_back(mesh.triangles[7]);
  std::swap(mesh.triangles[100][0], mesh.triangles[100][1]);
  mesh.triangles.push_back({3, 3, 4});
  mesh.triangles.push_back({mesh.triangles[900][0], mesh.triangles[900][1], 5});
  for (const std::uint64_t memory : {k_little, std::uint64_t{1} << 28}) {
    CAPTURE(memory);
    const SurfaceTopology both = measured(mesh, memory);
    const Topology whole = measure_topology(mesh);
    check_same(both.as_it_is, whole);
    CHECK(both.as_it_is.vertices == whole.vertices);
    check_same(both.welded, whole);
  }
}

TEST_CASE("where surfaces touch at seams they are apart, as in the whole") {
  for (const Mesh& mesh : {test::touching_row(400, false), test::touching_row(400, true),
                           test::torus_with_necks(300, 5)}) {
    const SurfaceTopology both = measured(mesh, k_little);
    check_same(both.welded, measure_topology(mesh));
    CHECK(both.welded.vertices == mesh.positions.size());
  }
}

TEST_CASE("a soup is one surface, once it is welded") {
  const Mesh mesh = test::torus(50, 30);
  const Mesh soup = soup_of(mesh);
  const SurfaceTopology both = measured(soup, k_little);
  check_same(both.as_it_is, measure_topology(soup));
  CHECK(both.as_it_is.components == 3000);
  check_same(both.welded, measure_topology(mesh));
  CHECK(both.welded.vertices == 1500);
}

TEST_CASE("surfaces that touch stay apart as in a run") {
  Mesh mesh = test::octahedron();
  test::append(mesh, test::octahedron());
  for (std::size_t v = 6; v < 12; ++v) mesh.positions[v].x += 2;
  const SurfaceTopology both = measured(mesh, std::uint64_t{1} << 28);
  CHECK(both.welded.components == 2);
  CHECK(both.welded.euler == 4);
}

TEST_CASE("many vertices at one point make no slab too large") {
  constexpr std::uint32_t k_many = 20'000;
  const Mesh mesh = test::with_crowd(test::grid(60, 30), k_many);
  const SurfaceTopology little = measured(mesh, k_little);
  const SurfaceTopology much = measured(mesh, std::uint64_t{1} << 30);
  check_same(little.as_it_is, measure_topology(mesh));
  check_same(little.welded, much.welded);
  CHECK(little.as_it_is.vertices == mesh.positions.size());
  CHECK(little.welded.vertices == mesh.positions.size() - k_many);
  const test::TempFolder folder;
  test::MemorySource source(mesh);
  const DividedSurface surface(source, {folder.path(), k_little, 2});
  std::size_t triangles = 0;
  surface.show([&](std::span<const Vec3> positions, std::span<const Triangle> piece) {
    const bool is_between_slabs = positions.size() == 3 * piece.size();
    CHECK((is_between_slabs || positions.size() < k_many / 10));
    triangles += piece.size();
  });
  CHECK(triangles == mesh.triangles.size());
}

TEST_CASE("triangles that are points are counted, however many") {
  constexpr std::uint32_t k_many = 30'000;
  Mesh mesh = test::grid(60, 30);
  mesh.triangles.insert(mesh.triangles.end(), k_many, Triangle{7, 7, 7});
  Mesh soup = mesh;  // the same, with vertices of their own
  for (std::size_t i = soup.triangles.size() - k_many; i < soup.triangles.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    soup.positions.insert(soup.positions.end(), 3, soup.positions[7]);
    soup.triangles[i] = {first, first + 1, first + 2};
  }
  for (const Mesh& each : {mesh, soup}) {
    const SurfaceTopology little = measured(each, k_little);
    check_same(little.as_it_is, measure_topology(each));
    check_same(little.welded, measure_topology(mesh));
  }
}

TEST_CASE("all triangles are shown, those between slabs too") {
  const Mesh mesh = test::torus(50, 30);
  const test::TempFolder folder;
  test::MemorySource source(mesh);
  const DividedSurface surface(source, {folder.path(), k_little, 2});
  double area = 0;
  std::size_t pieces = 0;
  const auto add = [&](std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    ++pieces;
    for (const auto& [a, b, c] : triangles) {
      area += length(cross(positions[b] - positions[a], positions[c] - positions[a]));
    }
  };
  surface.show(add);
  CHECK(pieces > 5);
  const double in_pieces = std::exchange(area, 0);
  add(mesh.positions, mesh.triangles);
  CHECK(in_pieces == doctest::Approx(area));
}

TEST_CASE("distances of divided surfaces are those of the meshes") {
  const test::TempFolder folder;
  const Mesh a = test::torus(80, 50);
  Mesh b = test::torus(20, 12);
  for (Vec3& p : b.positions) p.z += 0.05;
  test::MemorySource source_a(a);
  test::MemorySource source_b(b);
  const DividedSurface divided_a(source_a, {folder.path(), k_little, 2});
  const DividedSurface divided_b(source_b, {folder.path(), k_little, 2});
  const DistanceOptions options{.samples = 20'000};
  const Distance expected = measure_distance(a, b, options);
  const SurfaceError error = measure_error(divided_a, divided_b, options);
  const Distance& d = error.distance;
  CHECK(d.rms == doctest::Approx(expected.rms).epsilon(0.02));
  CHECK(d.mean == doctest::Approx(expected.mean).epsilon(0.02));
  CHECK(d.max == doctest::Approx(expected.max).epsilon(0.05));
  const DistanceQuantiles quantiles = measure_error({a, {}}, {b, {}}, {}, options).quantiles;
  CHECK(error.quantiles.p95 == doctest::Approx(quantiles.p95).epsilon(0.02));
  CHECK(error.quantiles.p99 == doctest::Approx(quantiles.p99).epsilon(0.02));
  CHECK_FALSE(error.normals);
  Mesh far = b;
  for (Vec3& p : far.positions) p.z += 100;
  test::MemorySource source_far(far);
  const DividedSurface divided_far(source_far, {folder.path(), k_little, 2});
  CHECK(measure_error(divided_far, divided_a, options).distance.mean ==
        doctest::Approx(100).epsilon(0.01));
}
