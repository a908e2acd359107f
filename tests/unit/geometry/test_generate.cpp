// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Mesh make(std::uint64_t triangles) {
  return in_memory(BumpyTorus(triangles));
}

Vec3 normal_of(const Mesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.positions[t[0]];
  return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
}

double longest_by_shortest(const Mesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
  const double ab = length(b - a), bc = length(c - b), ca = length(a - c);
  return std::max({ab, bc, ca}) / std::min({ab, bc, ca});
}

/// The distance of `p` from the circle along the middle of the tube.
double from_ring(Vec3 p) {
  return std::hypot(std::hypot(p.x, p.y) - 1, p.z);
}

std::string bytes_of(const std::vector<Vec3>& positions) {
  std::string bytes(positions.size() * sizeof(Vec3), '\0');
  std::memcpy(bytes.data(), positions.data(), bytes.size());
  return bytes;
}

}  // namespace

TEST_CASE("generate: closed, oriented outwards, one piece, a torus, at any size") {
  for (const std::uint64_t wanted : {200U, 201U, 999U, 5'000U, 123'456U}) {
    CAPTURE(wanted);
    const Mesh mesh = make(wanted);
    const Topology t = measure_topology(mesh);
    CHECK(t.used_vertices == t.vertices);
    CHECK(t.degenerate + t.zero_area + t.duplicate == 0);
    CHECK(t.border_edges + t.nonmanifold_edges + t.orientation_conflicts == 0);
    CHECK(t.components == 1);
    CHECK(t.euler == 0);
    double volume = 0;
    for (const Triangle& tri : mesh.triangles) {
      volume += dot(mesh.positions[tri[0]], normal_of(mesh, tri)) / 6;
    }
    CHECK(volume > 2);  // pi r^2 * 2 pi is 2.85 for a round tube
    CHECK(volume < 5);
  }
}

TEST_CASE("generate: about as many triangles as asked for") {
  for (const std::uint64_t wanted : {200U, 1'000U, 10'000U, 1'000'000U, 28'000'000U}) {
    CHECK(BumpyTorus(wanted).triangles() == wanted);
  }
  for (std::uint64_t wanted = 200; wanted < 5'000; wanted += 37) {
    CAPTURE(wanted);
    const auto got = static_cast<double>(BumpyTorus(wanted).triangles());
    CHECK(std::fabs(got - static_cast<double>(wanted)) <= 0.02 * static_cast<double>(wanted));
  }
  const std::uint64_t huge = 1'000'000'000'039;
  CHECK(static_cast<double>(BumpyTorus(huge).triangles()) == doctest::Approx(1e12).epsilon(1e-9));
}

TEST_CASE("generate: too few or absurdly many are refused") {
  CHECK_THROWS_AS(BumpyTorus(0), UsageError);
  CHECK_THROWS_AS(BumpyTorus(199), UsageError);
  CHECK_THROWS_AS(BumpyTorus(~std::uint64_t{0}), UsageError);
}

TEST_CASE("generate: coordinates are floats, and the same on every machine") {
  const Mesh mesh = make(20'000);
  for (const Vec3& p : mesh.positions) REQUIRE(p == rounded(p, PositionType::float32));
  CHECK(to_hex(checksum(bytes_of(mesh.positions))) == "22ebebaac033f98d");
}

TEST_CASE("generate: the surface does not depend on the number of triangles") {
  // Whatever the grid, its first vertex is the same point of the surface.
  const Vec3 first = make(200).positions[0];
  CHECK(make(50'000).positions[0] == first);
}

TEST_CASE("generate: triangles are well shaped") {
  for (const std::uint64_t wanted : {200U, 3'000U, 200'000U}) {
    CAPTURE(wanted);
    const Mesh mesh = make(wanted);
    std::vector<double> shapes;
    for (const Triangle& t : mesh.triangles) shapes.push_back(longest_by_shortest(mesh, t));
    std::sort(shapes.begin(), shapes.end());
    CHECK(shapes[shapes.size() / 2] < 2.5);
    CHECK(shapes.back() < 8);
  }
}

TEST_CASE("generate: the tube keeps clear of its own axis and of its centre") {
  for (const Vec3& p : make(300'000).positions) {
    REQUIRE(std::hypot(p.x, p.y) > 0.3);
    REQUIRE(from_ring(p) > 0.25);
    REQUIRE(from_ring(p) < 0.6);
  }
}

TEST_CASE("generate: some regions are smooth, others rough") {
  // Across the diagonal of each cell two triangles meet; how far do their normals turn?
  const Mesh mesh = make(400'000);
  std::size_t smooth = 0, rough = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) {
    const Vec3 a = normal_of(mesh, mesh.triangles[i]), b = normal_of(mesh, mesh.triangles[i + 1]);
    const double turned = std::atan2(length(cross(a, b)), dot(a, b));
    REQUIRE(turned < 1);
    smooth += turned < 0.003;
    rough += turned > 0.03;
  }
  const double cells = static_cast<double>(mesh.triangles.size()) / 2;
  CHECK(static_cast<double>(smooth) > 0.25 * cells);
  CHECK(static_cast<double>(rough) > 0.25 * cells);
}

TEST_CASE("a shuffled mesh is the same surface in another order, the same for the same seed") {
  const Mesh mesh = test::torus(40, 30);
  Mesh once = mesh;
  shuffle(once, 1);
  Mesh again = mesh;
  shuffle(again, 1);
  Mesh other = mesh;
  shuffle(other, 2);
  CHECK(once.positions == again.positions);
  CHECK(once.triangles == again.triangles);
  CHECK(once.triangles != other.triangles);
  CHECK(once.positions != mesh.positions);
  const auto sorted = [](const Mesh& m) {
    std::vector<std::array<std::array<double, 3>, 3>> all;
    for (const Triangle& t : m.triangles) {
      auto& corners = all.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = m.positions[t[k]];
        corners[k] = {p.x, p.y, p.z};
      }
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  CHECK(sorted(once) == sorted(mesh));
}
