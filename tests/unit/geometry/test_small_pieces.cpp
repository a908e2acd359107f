// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/topology.hpp>

#include "geometry/simplify/small_pieces.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::vector<std::array<Vec3, 3>> corners_of(const Mesh& mesh) {
  std::vector<std::array<Vec3, 3>> corners;
  for (const auto& [a, b, c] : mesh.triangles) {
    corners.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  }
  return corners;
}

/// A ball, squeezed and moved.
Mesh pebble(int levels, Vec3 size, Vec3 at) {
  Mesh ball = test::icosphere(levels);
  for (Vec3& p : ball.positions) p = Vec3{p.x * size.x, p.y * size.y, p.z * size.z} + at;
  return ball;
}

void check_equal(const SolidMoments& a, const SolidMoments& b) {
  CHECK(length(a.center - b.center) < 1e-9);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(a.spread[i] == doctest::Approx(b.spread[i]).epsilon(1e-9));
  }
}

/// The number of triangles that do not face away from the middle of their pebble. The middles
/// are 1 apart in a row.
std::size_t facing_wrong(const Mesh& mesh) {
  std::size_t wrong = 0;
  for (const auto& [first, second, third] : corners_of(mesh)) {
    const Vec3 middle{std::round(first.x), 0, 0};
    const Vec3 normal = cross(second - first, third - first);
    wrong += dot(normal, (first + second + third) * (1.0 / 3) - middle) > 0 ? 0 : 1;
  }
  return wrong;
}

}  // namespace

TEST_CASE("small pieces: the moments are those of the inside") {
  const Mesh ball = pebble(5, {1, 2, 0.5}, {3, -1, 7});
  const SolidMoments moments = moments_of(corners_of(ball));
  CHECK(moments.volume == doctest::Approx(4.0 / 3 * 3.14159265).epsilon(0.01));
  CHECK(length(moments.center - Vec3{3, -1, 7}) < 1e-9);
  CHECK(moments.spread[0] == doctest::Approx(0.2).epsilon(0.01));
  CHECK(moments.spread[3] == doctest::Approx(0.8).epsilon(0.01));
  CHECK(moments.spread[5] == doctest::Approx(0.05).epsilon(0.01));
}

TEST_CASE("small pieces: a tetrahedron is like what it stands for") {
  Mesh mesh = pebble(2, {1, 0.3, 0.1}, {});
  for (Vec3& p : mesh.positions) p = {p.x + 0.4 * p.y, p.y - 0.2 * p.z, p.z + 0.3 * p.x};
  const SolidMoments moments = moments_of(corners_of(mesh));
  const auto places = tetrahedron_like(moments);
  REQUIRE(places);
  const auto [a, b, c, d] = *places;
  check_equal(
      moments_of(std::vector<std::array<Vec3, 3>>{{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}}),
      moments);
}

TEST_CASE("small pieces: what is flat has no tetrahedron") {
  const Mesh flat = pebble(1, {1, 1, 0}, {});
  CHECK(!tetrahedron_like(moments_of(corners_of(flat))));
  CHECK(!tetrahedron_like({}));
}

TEST_CASE("small pieces: a map gives one body the moments of another") {
  const Mesh from = pebble(1, {1, 0.5, 0.4}, {1, 2, 3});
  const SolidMoments to = moments_of(corners_of(pebble(2, {0.9, 0.7, 0.2}, {0, 1, 0})));
  const auto map = map_between(moments_of(corners_of(from)), to);
  REQUIRE(map);
  Mesh mapped = from;
  for (Vec3& p : mapped.positions) p = (*map)(p);
  check_equal(moments_of(corners_of(mapped)), to);
  CHECK(!map_between({}, to));
}

TEST_CASE("small pieces: what is left of pebbles faces as they do where crossings are avoided") {
  constexpr int k_pebbles = 40;
  Mesh all;
  for (int i = 0; i < k_pebbles; ++i) {
    const Mesh one = pebble(1, {0.3, 0.2 + 0.004 * i, 0.05}, {static_cast<double>(i), 0, 0});
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), one.positions.begin(), one.positions.end());
    for (const auto& [a, b, c] : one.triangles) {
      all.triangles.push_back({a + first, b + first, c + first});
    }
  }
  SimplifyOptions options{.positions = PositionType::float32};
  options.lines.crossings = CrossingMode::avoid;
  options.lines.topology = TopologyMode::keep;
  Simplifier simplifier(all, options);
  simplifier.reduce({.triangles = 4 * k_pebbles});
  CHECK(simplifier.triangles() == 4 * k_pebbles);
  CHECK(measure_topology(simplifier.mesh()).components == k_pebbles);
  CHECK(facing_wrong(simplifier.mesh()) == 0);
}
