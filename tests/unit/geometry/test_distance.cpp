// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/bvh.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Mesh moved(Mesh mesh, Vec3 by, double scale = 1) {
  for (Vec3& p : mesh.positions) p = p * scale + by;
  return mesh;
}

Distance measure(const Mesh& from, const Mesh& to, std::uint64_t samples = 20'000) {
  return measure_distance(from, to, {samples, 2});
}

/// Random triangles in the unit cube: big and small ones, needles, segments and points.
Mesh soup(std::size_t triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Vec3 a{unit(random), unit(random), unit(random)};
    const double size = i % 10 == 0 ? 1 : 0.05;
    const auto near = [&] {
      return a + Vec3{unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5} * size;
    };
    const Vec3 b = i % 11 == 5 ? a : near();
    const Vec3 c = i % 7 == 3 ? a + (b - a) * 0.4 : i % 7 == 4 ? b + (a - b) * 1e-9 : near();
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

double nearest_slowly(const Mesh& mesh, Vec3 p) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    best = std::min(best,
                    squared_distance(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  }
  return best;
}

/// A rough height field above 60 x 60 squares, `tall` times as high as they are wide.
Mesh heights(double tall) {
  constexpr std::uint32_t k_side = 61;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  Mesh mesh;
  for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
    const double x = i % k_side;
    const double y = std::floor(i / double{k_side});
    mesh.positions.push_back(
        {x, y, tall * (20 * std::sin(x / 9) * std::cos(y / 7) + unit(random))});
  }
  for (std::uint32_t i = 0; i + k_side < k_side * k_side; ++i) {
    if (i % k_side == k_side - 1) continue;
    mesh.triangles.push_back({i, i + 1, i + k_side});
    mesh.triangles.push_back({i + 1, i + k_side + 1, i + k_side});
  }
  return mesh;
}

std::size_t touching_leaves(const Mesh& mesh) {
  const Bvh bvh(mesh, 1);
  std::vector<Bvh::Leaf> found;
  for (const Bvh::Leaf& leaf : bvh.leaves()) bvh.find_touching(leaf, found);
  return found.size();
}

}  // namespace

TEST_CASE("distance: a point and a triangle, seen from each of its seven sides and above") {
  //  c
  //  | \        right angle at a, legs 1
  //  a---b
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  const auto squared = [&](Vec3 p) { return squared_distance(p, a, b, c); };
  CHECK(squared({0.25, 0.25, 3}) == doctest::Approx(9));
  CHECK(squared({0.25, 0.25, -3}) == doctest::Approx(9));
  CHECK(squared({0.25, 0.25, 0}) == 0);
  CHECK(squared({0.5, -2, 1}) == doctest::Approx(5));
  CHECK(squared({-2, 0.5, 1}) == doctest::Approx(5));
  CHECK(squared({1, 1, 1}) == doctest::Approx(1.5));
  CHECK(squared({-1, -1, 1}) == doctest::Approx(3));
  CHECK(squared({3, -1, 0}) == doctest::Approx(5));
  CHECK(squared({-1, 3, 0}) == doctest::Approx(5));
}

TEST_CASE("distance: triangles without area are the segments and points that they are") {
  const Vec3 a{0, 0, 0}, b{2, 0, 0}, c{1, 0, 0}, p{1.5, 2, 0};
  CHECK(squared_distance(p, a, b, c) == doctest::Approx(4));
  CHECK(squared_distance(p, c, a, b) == doctest::Approx(4));
  CHECK(squared_distance(p, a, a, b) == doctest::Approx(4));
  CHECK(squared_distance(p, a, b, b) == doctest::Approx(4));
  CHECK(squared_distance(p, a, a, a) == doctest::Approx(6.25));
}

TEST_CASE("distance: the tree finds what a look at every triangle finds") {
  for (const std::uint32_t triangles : {1U, 2U, 4U, 5U, 17U, 600U}) {
    for (const double scale : {1.0, 1e-12, 1e12}) {
      for (const double far : {0.0, 1e6}) {
        CAPTURE(triangles);
        CAPTURE(scale);
        CAPTURE(far);
        const Vec3 at{far * scale, -far * scale, far * scale};
        const Mesh mesh = moved(soup(triangles, 5), at, scale);
        const Bvh bvh(mesh, 1);
        std::mt19937 random(9);
        std::uniform_real_distribution<double> around(-1, 2);
        for (int i = 0; i < 100; ++i) {
          const double reach = i % 10 == 0 ? 1e9 : 1;
          const Vec3 p =
              Vec3{around(random), around(random), around(random)} * (scale * reach) + at;
          const Bvh::Nearest nearest = bvh.nearest(p, static_cast<std::uint32_t>(i) % triangles);
          REQUIRE(nearest.squared == nearest_slowly(mesh, p));
        }
      }
    }
  }
}

TEST_CASE("distance: the tree tells sheets apart that floats do not") {
  // All eight sheets lie within two float steps: only careful rounding finds the nearest.
  Mesh mesh;
  const Mesh sheet = test::grid(6, 6);
  for (int layer = 0; layer < 8; ++layer) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : sheet.positions) {
      mesh.positions.push_back(p + Vec3{0.1 * layer, 0.03 * layer, 0.7 + layer * 5e-8});
    }
    for (const auto& [a, b, c] : sheet.triangles) {
      mesh.triangles.push_back({a + first, b + first, c + first});
    }
  }
  mesh.positions.insert(mesh.positions.end(), {{3, 3, 5}, {4, 3, 5}, {3, 4, 5}});
  const auto last = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.triangles.push_back({last - 3, last - 2, last - 1});
  const Bvh bvh(mesh, 1);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{unit(random) * 7, unit(random) * 7, 0.7 + (unit(random) * 12 - 2) * 5e-8};
    const std::uint32_t guess = static_cast<std::uint32_t>(random() % mesh.triangles.size());
    REQUIRE(bvh.nearest(p, guess).squared == nearest_slowly(mesh, p));
  }
}

TEST_CASE("distance: boxes of stretched triangles overlap no more than those of others") {
  const std::size_t usual = touching_leaves(heights(1));
  for (const double tall : {1e2, 1e4, 1e6}) {
    CAPTURE(tall);
    Mesh mesh = heights(tall);
    CHECK(touching_leaves(mesh) < 2 * usual);
    for (Vec3& p : mesh.positions) p = {p.z, p.x, p.y};
    CHECK(touching_leaves(mesh) < 2 * usual);
    const Bvh bvh(mesh, 1);
    for (std::uint32_t v = 0; v < mesh.positions.size(); v += 37) {
      const Vec3 p = mesh.positions[v] + Vec3{0.1 * tall, 0.2, 0.3};
      CHECK(bvh.nearest(p, v).squared == nearest_slowly(mesh, p));
    }
  }
}

TEST_CASE("distance: many triangles of one centre do not deepen the tree") {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const double r = 1 + i;
    mesh.positions.insert(mesh.positions.end(), {{r, 0, 0}, {-r / 2, r, 0}, {-r / 2, -r, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Bvh bvh(mesh, 1);
  CHECK(bvh.nearest({0, 0, 5}, 1999).squared == 25);
  CHECK(bvh.nearest({2001, 0, 0}, 0).squared == 1);
}

TEST_CASE("distance: a surface is where it is") {
  const Mesh mesh = test::torus(40, 20);
  const Distance none = measure(mesh, mesh);
  CHECK(none.max < 1e-15);
  CHECK(none.rms <= none.max);
}

TEST_CASE("distance: parallel sheets are as far apart as they are") {
  const Mesh sheet = test::grid(7, 5);
  const Distance apart = measure(sheet, moved(sheet, {0, 0, 0.25}));
  CHECK(apart.rms == doctest::Approx(0.25).epsilon(1e-12));
  CHECK(apart.mean == doctest::Approx(0.25).epsilon(1e-12));
  CHECK(apart.max == doctest::Approx(0.25).epsilon(1e-12));
}

TEST_CASE("distance: far from the origin as near it") {
  const Vec3 far{5e6, -3e6, 1e6};
  const Mesh sheet = moved(test::grid(50, 50), far);
  const Distance apart = measure(sheet, moved(sheet, {0, 0, 1e-3}));
  CHECK(apart.rms == doctest::Approx(1e-3).epsilon(1e-5));
  CHECK(apart.max == doctest::Approx(1e-3).epsilon(1e-5));
}

TEST_CASE("distance: rms, mean and maximum of a slope above a plane") {
  // Heights 0 to 1, evenly distributed: mean 1/2, root mean square 1/sqrt(3).
  Mesh slope = test::grid(9, 4);
  for (Vec3& p : slope.positions) p.z = p.x / 9;
  const Mesh plane = moved(test::grid(1, 1), {-50, -50, 0}, 100);
  const Distance distance = measure(slope, plane);
  CHECK(distance.mean == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(distance.rms == doctest::Approx(1 / std::sqrt(3.0)).epsilon(1e-3));
  CHECK(distance.max <= 1);
  CHECK(distance.max > 0.999);
}

TEST_CASE("distance: samples are spread by area, not by triangle") {
  // A big square in the plane, and above it one with 1 % of its area but many more triangles.
  Mesh mesh = moved(test::grid(1, 1), {}, 10);
  const Mesh fine = moved(test::grid(30, 30), {0, 0, 1}, 1.0 / 30);
  for (const auto& [a, b, c] : fine.triangles) mesh.triangles.push_back({a + 4, b + 4, c + 4});
  mesh.positions.insert(mesh.positions.end(), fine.positions.begin(), fine.positions.end());
  const Mesh plane = moved(test::grid(1, 1), {-50, -50, 0}, 100);
  CHECK(measure(mesh, plane).mean == doctest::Approx(1.0 / 101).epsilon(1e-2));
}

TEST_CASE("distance: is measured one way") {
  const Mesh small = test::grid(1, 1), big = test::grid(2, 1);
  CHECK(measure(small, big).max < 1e-12);
  // Half of the big sheet is up to 1 beyond the edge of the small one: mean 1/4, rms sqrt(1/6).
  const Distance beyond = measure(big, small);
  CHECK(beyond.mean == doctest::Approx(0.25).epsilon(1e-3));
  CHECK(beyond.rms == doctest::Approx(std::sqrt(1.0 / 6)).epsilon(1e-3));
  CHECK(beyond.max > 0.99);
}

TEST_CASE("distance: does not depend on the threads") {
  const Mesh from = test::icosphere(3), to = soup(500, 11);
  const Distance one = measure_distance(from, to, {10'000, 1});
  for (const unsigned threads : {0U, 2U, 3U, 16U}) {
    const Distance more = measure_distance(from, to, {10'000, threads});
    CHECK(more.rms == one.rms);
    CHECK(more.mean == one.mean);
    CHECK(more.max == one.max);
  }
}

TEST_CASE("distance: few samples, and zero") {
  const Mesh sheet = test::grid(2, 2);
  CHECK(measure(sheet, moved(sheet, {0, 0, 2}), 1).max == doctest::Approx(2));
  CHECK(measure(sheet, moved(sheet, {0, 0, 2}), 1025).rms == doctest::Approx(2));
  CHECK_THROWS_AS(measure(sheet, sheet, 0), UsageError);
}

TEST_CASE("distance: meshes without a surface or without finite coordinates are refused") {
  const Mesh sheet = test::grid(2, 2);
  const Mesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}}};
  Mesh broken = sheet;
  Mesh huge = moved(sheet, {}, 1e200);
  broken.positions[4].y = std::numeric_limits<double>::quiet_NaN();
  for (const Mesh& bad : {Mesh{}, line, broken, huge}) {
    CHECK_THROWS_AS(measure(bad, sheet), DataError);
    CHECK_THROWS_AS(measure(sheet, bad), DataError);
  }
}

TEST_CASE("samples and a meter measure what measure_distance does") {
  const Mesh from = test::torus(40, 20), to = test::torus(20, 10);
  const Distance whole = measure_distance(from, to, {.samples = 5000});
  const SurfaceSamples samples = sample_surface(from, {.samples = 5000});
  CHECK(samples.points.size() == 5000);
  CHECK(samples.area == doctest::Approx(4 * std::acos(-1.0) * std::acos(-1.0) * 0.4).epsilon(0.03));
  const DistanceMeter meter(to, 2);
  const Distance measured = meter.measure(samples.points);
  CHECK(measured.rms == doctest::Approx(whole.rms).epsilon(1e-9));
  CHECK(measured.max == doctest::Approx(whole.max).epsilon(1e-9));
  CHECK(meter.measure({}).rms == 0);
  const DistanceMeter::Points all(samples.points);
  const std::vector<DistanceMeter::Points> sets{all.first(10), {}, all.subspan(10), all};
  const std::vector<Distance> each = meter.measure_each(sets);
  REQUIRE(each.size() == 4);
  for (std::size_t i = 0; i < each.size(); ++i) {
    CHECK(each[i].rms == meter.measure(sets[i]).rms);
    CHECK(each[i].mean == DistanceMeter(to, 1).measure(sets[i]).mean);
  }
  CHECK(std::max(each[0].max, each[2].max) == each[3].max);
  std::vector<double> of_points(10'000);
  meter.measure_each(sets, of_points);
  CHECK(*std::max_element(of_points.begin(), of_points.begin() + 10) == each[0].max);
  CHECK(std::equal(of_points.begin(), of_points.begin() + 5000, of_points.begin() + 5000));
  for (std::size_t i = 0; i < 5000; i += 100) {
    CHECK(of_points[i] == meter.measure(all.subspan(i, 1)).max);
    CHECK(meter.farthest(all.subspan(i, 100), 0) ==
          *std::max_element(&of_points[i], &of_points[i] + 100));
  }
  CHECK(sample_surface({}, {.samples = 10}).points.empty());
}
