// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/piece_samples.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

TEST_CASE("samples of a piece lie on it, and stand for its area and volume") {
  const Mesh sphere = test::icosphere(3);
  const PieceSamples samples = sample_piece(sphere.positions, sphere.triangles, 500, {9, 8, 7});
  CHECK(samples.points.size() == 500);
  CHECK(samples.area == doctest::Approx(4 * 3.14159).epsilon(0.02));
  CHECK(samples.volume == doctest::Approx(4 * 3.14159 / 3).epsilon(0.03));
  std::size_t above = 0;
  for (const FacingPoint& p : samples.points) {
    CHECK(length(p.at) == doctest::Approx(1).epsilon(0.02));
    CHECK(dot(p.at, p.normal) > 0);
    if (p.at.z > 0) ++above;
  }
  CHECK(above > 200);
  CHECK(above < 300);
  const auto points_for = [](double area) { return static_cast<std::uint64_t>(10 * area); };
  CHECK(sample_piece(sphere.positions, sphere.triangles, points_for, {}).points.size() == 125);
  const Mesh flat{.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}};
  CHECK(sample_piece(flat.positions, flat.triangles, 10, {}).points.empty());
}

TEST_CASE("places tell the distance, the triangle, and how that is turned") {
  const Mesh floor{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  const TriangleIndex index(floor, 1);
  const std::vector<FacingPoint> points = {
      {{0.2, 0.2, 2}, {0, 0, 3}}, {{0.2, 0.2, -1}, {0, 0, -1}}, {{0.2, 0.2, 0}, {1, 0, 1}}};
  const std::vector<NearPlace> places = find_near_places(index, points, 2);
  REQUIRE(places.size() == 3);
  CHECK(places[0].distance == doctest::Approx(2));
  CHECK(places[0].degrees == doctest::Approx(0));
  CHECK(places[1].distance == doctest::Approx(1));
  CHECK(places[1].degrees == doctest::Approx(180));
  CHECK(places[2].degrees == doctest::Approx(45));
}
