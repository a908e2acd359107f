// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/merge_near.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::vector<Vec3> scattered_places(std::size_t count, double side, Vec3 from = {}) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(0, side);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = from + Vec3{at(random), at(random), at(random)};
  return points;
}

std::vector<Vec3> taken_by(const std::vector<Vec3>& points, double distance) {
  std::vector<Vec3> taken;
  for (const std::uint32_t i : merge_near(points, distance)) taken.push_back(points[i]);
  return taken;
}

auto coordinates_of(Vec3 p) {
  return std::tuple(p.x, p.y, p.z);
}

std::vector<Vec3> distinct_places(std::vector<Vec3> points) {
  const auto less = [](Vec3 a, Vec3 b) { return coordinates_of(a) < coordinates_of(b); };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

TEST_CASE("merge_near: nothing in, nothing out") {
  CHECK(merge_near({}, 1).empty());
}

TEST_CASE("merge_near: none goes far, those that stay are apart, and each takes the nearest") {
  // From hardly any neighbours to hundreds each, also far from the origin.
  for (const Vec3 from : {Vec3{}, Vec3{-0.5, -0.5, -0.5}, Vec3{5e5, 4e6, 100}}) {
    const std::vector<Vec3> points = scattered_places(1000, 1, from);
    for (const double distance : {0.02, 0.1, 0.5}) {
      CAPTURE(distance);
      const std::vector<Vec3> taken = taken_by(points, distance);
      const std::vector<Vec3> stay = distinct_places(taken);
      CHECK(stay.size() < points.size());
      for (std::size_t i = 0; i < stay.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) CHECK(length(stay[i] - stay[j]) > distance);
      }
      for (std::size_t i = 0; i < points.size(); ++i) {
        double nearest = distance;
        for (const Vec3& p : stay) nearest = std::min(nearest, length(p - points[i]));
        CHECK(length(taken[i] - points[i]) == doctest::Approx(nearest));
      }
    }
  }
}

TEST_CASE("merge_near: the positions taken do not depend on the order") {
  std::vector<Vec3> points = scattered_places(2000, 1);
  points.insert(points.end(), points.begin(), points.begin() + 500);
  const std::vector<Vec3> taken = taken_by(points, 0.1);
  std::vector<std::uint32_t> order(points.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::vector<Vec3> shuffled;
  for (const std::uint32_t i : order) shuffled.push_back(points[i]);
  const std::vector<Vec3> again = taken_by(shuffled, 0.1);
  for (std::size_t i = 0; i < order.size(); ++i) CHECK(again[i] == taken[order[i]]);
}

TEST_CASE("merge_near: corners that were moved by less than the distance become one again") {
  const Mesh mesh = test::icosphere(3);
  for (const double scale : {1e-6, 1.0, 1e9}) {
    Mesh soup = test::jittered_soup(mesh, 1e-4);
    for (Vec3& p : soup.positions) p = p * scale;
    const std::vector<Vec3> taken = taken_by(soup.positions, 4e-4 * scale);
    CHECK(distinct_places(soup.positions).size() == 3 * mesh.triangles.size());
    CHECK(distinct_places(taken).size() == mesh.positions.size());
  }
}

TEST_CASE("merge_near: nothing is merged where coordinates are coarser than the distance") {
  const std::vector<Vec3> points{{1e18, 0, 0}, {1e18 + 256, 0, 0}, {1e18, 128, 0}, {1e18, 0, 0}};
  CHECK(merge_near(points, 1e-3) == std::vector<std::uint32_t>{0, 1, 2, 0});
}
