// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// Random triangles in the unit cube: many small ones, a few that span it, needles and points.
Mesh metered_soup(std::size_t triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Vec3 a{unit(random), unit(random), unit(random)};
    const double size = i % 50 == 0 ? 1 : 0.03;
    const auto near = [&] {
      return a + Vec3{unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5} * size;
    };
    const Vec3 b = i % 11 == 5 ? a : near();
    const Vec3 c = i % 7 == 3 ? a + (b - a) * 0.4 : near();
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// Points in and around the unit cube, some of them far away.
std::vector<Vec3> scattered(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p{unit(random), unit(random), unit(random)};
    points.push_back(i % 20 == 0 ? p * 9 - Vec3{4, 4, 4} : p);
  }
  return points;
}

double nearest_of_all(const Mesh& mesh, Vec3 p) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    best = std::min(best,
                    squared_distance(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  }
  return std::sqrt(best);
}

struct Shown {
  std::vector<double> distances;
  int passes = 0;
  std::size_t pieces = 0;
};

/// Shows the mesh in pieces of `piece` triangles.
Shown metered(std::span<const Vec3> points, const Mesh& mesh, PointMeterHints hints,
              std::size_t piece = 100, unsigned threads = 1) {
  hints.surface = std::span(mesh.positions).first(10);
  PointMeter meter(points, hints);
  Shown shown;
  while (meter.begin_pass()) {
    ++shown.passes;
    const std::size_t pieces = (mesh.triangles.size() + piece - 1) / piece;
    std::vector<std::uint8_t> is_shown(pieces, 0);
    parallel_for(pieces, threads, [&](std::uint64_t i) {
      const std::size_t first = i * piece;
      const auto some =
          std::span(mesh.triangles).subspan(first, std::min(piece, mesh.triangles.size() - first));
      Box box;
      for (const Triangle& t : some) {
        for (const std::uint32_t v : t) box.add(mesh.positions[v]);
      }
      if (!meter.wants(box)) return;
      is_shown[i] = 1;
      meter.show(mesh.positions, some);
    });
    shown.pieces += static_cast<std::size_t>(std::count(is_shown.begin(), is_shown.end(), 1));
  }
  shown.distances = meter.distances();
  return shown;
}

}  // namespace

TEST_CASE("each point finds the distance that looking at every triangle finds") {
  const Mesh mesh = metered_soup(3'000, 1);
  const std::vector<Vec3> points = scattered(400, 2);
  for (const PointMeterHints& hints : std::vector<PointMeterHints>{{0.03, 0.05, {}},
                                                                   {0.03, 0, {}},
                                                                   {0, 0, {}},
                                                                   {0.001, 0.02, {}},
                                                                   {10, 10, {}},
                                                                   {0.03, 0.05, {}, true}}) {
    CAPTURE(hints.usual);
    const Shown shown = metered(points, mesh, hints);
    CHECK(shown.passes <= (hints.all_are_beyond ? 1 : 2));
    for (std::size_t i = 0; i < points.size(); ++i) {
      REQUIRE(shown.distances[i] ==
              doctest::Approx(nearest_of_all(mesh, points[i])).epsilon(1e-12));
    }
  }
}

TEST_CASE("no distance depends on hints, pieces or threads") {
  const Mesh mesh = metered_soup(3'000, 3);
  const std::vector<Vec3> points = scattered(400, 4);
  const std::vector<double> expected = metered(points, mesh, {0.03, 0.05, {}}).distances;
  CHECK(metered(points, mesh, {0.3, 0.001, {}}).distances == expected);
  CHECK(metered(points, mesh, {0.03, 0.05, {}}, 7).distances == expected);
  CHECK(metered(points, mesh, {0.03, 0.05, {}}, 3'000).distances == expected);
  CHECK(metered(points, mesh, {0.03, 0.05, {}}, 10, 3).distances == expected);
}

TEST_CASE("where points crowd, each looks for its triangle: the same distances") {
  const Mesh mesh = metered_soup(3'000, 3);
  const std::vector<Vec3> points = scattered(4'000, 4);
  const std::vector<double> expected = metered(points, mesh, {0.001, 0.002, {}}).distances;
  for (const double reach : {0.2, 1.0, 10.0}) {
    CAPTURE(reach);
    CHECK(metered(points, mesh, {0.03, reach, {}}, 3'000).distances == expected);
    CHECK(metered(points, mesh, {0.03, reach, {}}, 700, 3).distances == expected);
    CHECK(metered(points, mesh, {0.03, reach, {}}, 7).distances == expected);
  }
}

TEST_CASE("the last pass asks only for what is near the points that found nothing") {
  const Mesh mesh = test::grid(100, 100);
  std::vector<Vec3> points;
  for (int i = 0; i < 100; ++i) points.push_back({i + 0.3, 50.2, 0.01});
  CHECK(metered(points, mesh, {1, 0.5, {}}).passes == 1);
  const Shown near = metered(points, mesh, {1, 0.5, {}});
  points.push_back({3, 3, 7});
  const Shown shown = metered(points, mesh, {1, 0.5, {}});
  CHECK(shown.passes == 2);
  CHECK(shown.distances.back() == doctest::Approx(7));
  CHECK(shown.pieces < near.pieces + 120);  // of 200
}

TEST_CASE("vertices and middles are those of triangles with an area") {
  const std::vector<Vec3> positions = {{0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {9, 9, 9}, {2, 0, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 0, 3}, {0, 1, 4}};
  CHECK(vertices_of_surface(positions, triangles) ==
        std::vector<Vec3>{positions[0], positions[1], positions[2]});
  CHECK(middles_of_longest_sides(positions, triangles) == std::vector<Vec3>{{2, 0.5, 0}});
}

TEST_CASE("no points need no pass") {
  PointMeter meter({}, {1, 1, {}});
  CHECK_FALSE(meter.begin_pass());
  CHECK(meter.distances().empty());
}

TEST_CASE("far from the origin, and where all points are one") {
  Mesh mesh = metered_soup(500, 5);
  std::vector<Vec3> points(30, Vec3{5e5 + 0.3, 4e6 + 0.4, 0.5});
  for (Vec3& p : mesh.positions) p = p + Vec3{5e5, 4e6, 0};
  const Shown shown = metered(points, mesh, {0.03, 0.02, {}});
  for (const double d : shown.distances) {
    CHECK(d == doctest::Approx(nearest_of_all(mesh, points[0])).epsilon(1e-9));
  }
}
