// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/channel_fit.hpp>

#include "geometry/bvh.hpp"
#include "geometry/random_unit.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Vec3 random_vector(std::uint64_t n) {
  return Vec3{random_unit(3 * n), random_unit(3 * n + 1), random_unit(3 * n + 2)} * 2 -
         Vec3{1, 1, 1};
}

/// Two values per point: a formula's, and 7.
template <class Value>
std::vector<float> values_at(const std::vector<Vec3>& points, Value value) {
  std::vector<float> values;
  for (const Vec3& p : points) {
    values.push_back(static_cast<float>(value(p)));
    values.push_back(7);
  }
  return values;
}

/// A fit on `coarse` of the values at the points: two channels, the second is 7 everywhere.
template <class Value>
ChannelFit fitted(const Mesh& coarse, const std::vector<Vec3>& points, Value value,
                  unsigned threads = 1) {
  ChannelFit fit(coarse, {2, points.size(), threads});
  fit.add(points, values_at(points, value));
  return fit;
}

}  // namespace

TEST_CASE("shares of a triangle's corners lead to its nearest point") {
  const std::vector<Mesh> triangles = {
      {{{0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0.2}}, {{0, 1, 2}}},
      {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}},
      {{{0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0}}, {{0, 1, 2}}},
      {{{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}}, {{0, 1, 2}}}};
  for (const Mesh& mesh : triangles) {
    const Vec3 a = mesh.positions[0];
    const Vec3 b = mesh.positions[1];
    const Vec3 c = mesh.positions[2];
    for (std::uint64_t n = 0; n < 2000; ++n) {
      const Vec3 p = random_vector(n) * 1.5;
      const auto [x, y, z] = nearest_shares(p, a, b, c);
      REQUIRE(std::min({x, y, z}) >= -1e-12);
      REQUIRE(x + y + z == doctest::Approx(1));
      const double squared = squared_length(a * x + b * y + c * z - p);
      REQUIRE(squared == doctest::Approx(squared_distance(p, a, b, c)).epsilon(1e-9));
    }
  }
}

TEST_CASE("what is linear on each triangle is found again") {
  const Mesh sheet = test::grid(8, 8);
  std::vector<Vec3> points;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    points.push_back({8 * random_unit(2 * n), 8 * random_unit(2 * n + 1), 0.001});
  }
  const auto slope = [](Vec3 p) { return 3 * p.x - 2 * p.y + 50; };
  const ChannelFit fit = fitted(sheet, points, slope);
  const std::vector<float> values = fit.values();
  REQUIRE(values.size() == 2 * sheet.positions.size());
  for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
    // Each value is pulled a little towards its neighbours' mean, which shows at the rim.
    CHECK(std::abs(static_cast<double>(values[2 * v]) - slope(sheet.positions[v])) < 0.1);
    CHECK(values[2 * v + 1] == doctest::Approx(7));
  }
  const std::vector<double> rms = fit.rms(values);
  CHECK(rms[0] < 0.05);
  CHECK(rms[1] < 1e-4);
}

TEST_CASE("the error told is what is measured") {
  const Mesh sphere = test::icosphere(2);
  const std::vector<Vec3> points = test::icosphere(5).positions;
  const auto wave = [](Vec3 p) { return 100 * std::sin(5 * p.x) + 20 * p.y; };
  ChannelFit fit(sphere, {2, 1, 1});  // takes all points
  fit.add(points, values_at(points, wave));
  const std::vector<float> values = fit.values();
  const Bvh bvh(sphere, 1);
  double squares = 0;
  for (const Vec3& p : points) {
    const Triangle& t = sphere.triangles[bvh.nearest(p, 0).triangle];
    const auto shares =
        nearest_shares(p, sphere.positions[t[0]], sphere.positions[t[1]], sphere.positions[t[2]]);
    double there = -wave(p);
    for (std::size_t k = 0; k < 3; ++k) there += shares[k] * static_cast<double>(values[2 * t[k]]);
    squares += there * there;
  }
  const double rms = std::sqrt(squares / static_cast<double>(points.size()));
  CHECK(fit.rms(values)[0] == doctest::Approx(rms).epsilon(0.01));
  CHECK(rms > 1);

  // Lower than if each vertex had the wave's value at its own place.
  ChannelFit other(sphere, {2, 1, 1});
  other.add(points, values_at(points, wave));
  CHECK(rms < 0.95 * other.rms(values_at(sphere.positions, wave))[0]);
}

TEST_CASE("a vertex that no point tells of has its neighbours' values") {
  const Mesh sheet = test::grid(20, 20);
  const ChannelFit fit = fitted(sheet, {{0.2, 0.2, 0}, {0.3, 0.1, 0}}, [](Vec3) { return 5; });
  for (const float value : fit.values())
    CHECK((value == doctest::Approx(5) || value == doctest::Approx(7)));

  const std::vector<float> nothing = fitted(sheet, {}, [](Vec3) { return 5; }).values();
  CHECK(std::all_of(nothing.begin(), nothing.end(), [](float value) { return value == 0; }));
}

TEST_CASE("threads and batches change nothing") {
  const Mesh sphere = test::icosphere(3);
  const std::vector<Vec3> points = test::icosphere(6).positions;
  const auto wave = [](Vec3 p) { return std::sin(9 * p.x) + p.z; };
  const std::vector<float> values = fitted(sphere, points, wave, 1).values();
  CHECK(fitted(sphere, points, wave, 4).values() == values);
  ChannelFit fit(sphere, {2, points.size(), 2});
  for (std::size_t i = 0; i < points.size(); i += 1000) {
    const std::vector<Vec3> some(
        points.begin() + static_cast<std::ptrdiff_t>(i),
        points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), i + 1000)));
    fit.add(some, values_at(some, wave));
  }
  CHECK(fit.values() == values);
}
