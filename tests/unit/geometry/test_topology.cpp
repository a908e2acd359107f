// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include <doctest/doctest.h>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

void check_same(const Topology& a, const Topology& b) {
  CHECK(a.vertices == b.vertices);
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

/// The counts by their definitions, with maps and sets. Areas are ignored.
Topology measure_slowly(const Mesh& mesh) {
  Topology topology;
  topology.vertices = mesh.positions.size();
  topology.triangles = mesh.triangles.size();
  std::set<Triangle> known;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed, undirected;
  std::map<std::uint32_t, std::uint32_t> component;
  for (Triangle t : mesh.triangles) {
    if (std::set<std::uint32_t>(t.begin(), t.end()).size() < 3) {
      ++topology.degenerate;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      ++directed[{t[k], t[(k + 1) % 3]}];
      ++undirected[std::minmax(t[k], t[(k + 1) % 3])];
      component.emplace(t[k], t[k]);
    }
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t gone = component[t[k]], kept = component[t[0]];
      for (auto& [vertex, label] : component) label = label == gone ? kept : label;
    }
    std::sort(t.begin(), t.end());
    topology.duplicate += !known.insert(t).second;
  }
  for (const auto& [edge, uses] : directed) {
    topology.orientation_conflicts += static_cast<std::uint64_t>(uses - 1);
  }
  for (const auto& [edge, uses] : undirected) {
    topology.border_edges += uses == 1;
    topology.nonmanifold_edges += uses > 2;
    topology.unmatched_edges += directed[edge] != directed[{edge.second, edge.first}];
  }
  std::set<std::uint32_t> labels;
  for (const auto& [vertex, label] : component) labels.insert(label);
  topology.edges = undirected.size();
  topology.used_vertices = component.size();
  topology.components = labels.size();
  topology.euler = static_cast<std::int64_t>(component.size()) -
                   static_cast<std::int64_t>(undirected.size()) +
                   static_cast<std::int64_t>(topology.triangles - topology.degenerate);
  return topology;
}

}  // namespace

TEST_CASE("topology: an empty mesh, and one of vertices only") {
  check_same(measure_topology({}), {});
  Topology points;
  points.vertices = 2;
  check_same(measure_topology({{{0, 0, 0}, {1, 0, 0}}, {}}), points);
}

TEST_CASE("topology: closed surfaces have no border and the Euler number of their genus") {
  const Topology sphere = measure_topology(test::icosphere(3));
  CHECK(sphere.vertices == 642);
  CHECK(sphere.used_vertices == 642);
  CHECK(sphere.triangles == 1280);
  CHECK(sphere.edges == 1920);
  CHECK(sphere.border_edges == 0);
  CHECK(sphere.nonmanifold_edges == 0);
  CHECK(sphere.orientation_conflicts == 0);
  CHECK(sphere.components == 1);
  CHECK(sphere.euler == 2);
  CHECK(measure_topology(test::tetrahedron()).euler == 2);
  CHECK(measure_topology(test::octahedron()).euler == 2);
  const Topology torus = measure_topology(test::torus(12, 9));
  CHECK(torus.border_edges == 0);
  CHECK(torus.components == 1);
  CHECK(torus.euler == 0);
}

TEST_CASE("topology: an open sheet") {
  const Topology sheet = measure_topology(test::grid(3, 2));
  CHECK(sheet.edges == 3 * 3 + 4 * 2 + 6);
  CHECK(sheet.border_edges == 10);
  CHECK(sheet.euler == 1);
}

TEST_CASE("topology: triangles that share a vertex are one component, without a common edge") {
  const Topology tie = measure_topology(test::bow_tie());
  CHECK(tie.components == 1);
  CHECK(tie.border_edges == 6);
  CHECK(tie.nonmanifold_edges == 0);
  CHECK(tie.euler == 1);
}

TEST_CASE("topology: three triangles on an edge, two of them running the same way") {
  const Topology fans = measure_topology(test::three_fans());
  CHECK(fans.edges == 7);
  CHECK(fans.nonmanifold_edges == 1);
  CHECK(fans.border_edges == 6);
  CHECK(fans.orientation_conflicts == 1);
}

TEST_CASE("topology: a flipped triangle conflicts on its three edges") {
  Mesh mesh = test::icosphere(1);
  std::swap(mesh.triangles[17][0], mesh.triangles[17][2]);
  const Topology flipped = measure_topology(mesh);
  CHECK(flipped.orientation_conflicts == 3);
  CHECK(flipped.border_edges == 0);
}

TEST_CASE("topology: degenerate, zero-area and duplicate triangles, and unused vertices") {
  Mesh mesh = test::grid(1, 1);         // triangles 0 1 3 and 0 3 2
  mesh.positions.push_back({2, 2, 0});  // 4, in line with 0 and 3
  mesh.positions.push_back({9, 9, 9});  // 5, unused
  mesh.positions.push_back({9, 9, 9});  // 6, in a degenerate triangle only
  mesh.triangles.push_back({0, 3, 4});  // no area
  mesh.triangles.push_back({6, 6, 0});  // degenerate
  mesh.triangles.push_back({6, 6, 6});  // degenerate
  mesh.triangles.push_back({3, 0, 1});  // 0 1 3 once more
  mesh.triangles.push_back({1, 0, 3});  // and turned over
  const Topology t = measure_topology(mesh);
  CHECK(t.vertices == 7);
  CHECK(t.used_vertices == 5);
  CHECK(t.triangles == 7);
  CHECK(t.degenerate == 2);
  CHECK(t.zero_area == 1);
  CHECK(t.duplicate == 2);
  CHECK(t.components == 1);
  // 0-3 has five triangles, 0-1 and 1-3 have three; 0-2, 2-3, 3-4, 4-0 have one.
  CHECK(t.edges == 7);
  CHECK(t.nonmanifold_edges == 3);
  CHECK(t.border_edges == 4);
  CHECK(t.euler == 5 - 7 + 5);
}

TEST_CASE("topology: components are counted apart") {
  Mesh mesh = test::tetrahedron();
  const Mesh torus = test::torus(5, 4);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), torus.positions.begin(), torus.positions.end());
  for (const auto& [a, b, c] : torus.triangles) {
    mesh.triangles.push_back({a + first, b + first, c + first});
  }
  const Topology both = measure_topology(mesh);
  CHECK(both.components == 2);
  CHECK(both.euler == 2);
}

TEST_CASE("topology: one vertex of very many triangles") {
  // A fan about vertex 0, from the middle out, so that its edges come unsorted.
  const std::uint32_t rim = 3000;
  Mesh fan;
  fan.positions.resize(rim + 1);
  for (std::uint32_t i = 0; i < rim; ++i) {
    const std::uint32_t k = (i * 1237) % rim;  // 1237 and 3000 have no common divisor
    fan.triangles.push_back({0, k + 1, (k + 1) % rim + 1});
  }
  const Topology t = measure_topology(fan);
  CHECK(t.edges == 2 * rim);
  CHECK(t.border_edges == rim);
  CHECK(t.orientation_conflicts == 0);
  CHECK(t.euler == 1);
}

TEST_CASE("topology: agrees with a plain count on random triangles") {
  std::mt19937 random(3);
  for (const std::uint32_t vertices : {1U, 4U, 12U, 60U}) {
    for (const std::size_t triangles : {5U, 40U, 300U}) {
      CAPTURE(vertices);
      CAPTURE(triangles);
      Mesh mesh;
      for (std::uint32_t i = 0; i < vertices; ++i) {
        // On a paraboloid no three points are in line.
        mesh.positions.push_back({i * 1.0, i * 1.0 * i, 1});
      }
      for (std::size_t i = 0; i < triangles; ++i) {
        const auto pick = [&] { return static_cast<std::uint32_t>(random() % vertices); };
        mesh.triangles.push_back({pick(), pick(), pick()});
      }
      check_same(measure_topology(mesh), measure_slowly(mesh));
    }
  }
}

TEST_CASE("topology: an index out of range is refused") {
  Mesh mesh = test::tetrahedron();
  mesh.triangles[2][1] = 4;
  CHECK_THROWS_AS(measure_topology(mesh), DataError);
}
