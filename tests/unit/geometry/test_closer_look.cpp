// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/closer_look.hpp>

#include "geometry/bvh.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

const Mesh k_large = {.positions = {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}}, .triangles = {{0, 1, 2}}};

const std::vector<Vec3> k_inside = {{20, 30, 0}};
const std::vector<Vec3> k_corner = {{0, 0, 0}};

bool are_on(const Mesh& mesh, const Triangle& t, const std::vector<Vec3>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    return squared_distance(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]) <
           1e-18;
  });
}

}  // namespace

TEST_CASE("the farthest points come first, of two as far the one before") {
  const std::vector<double> distances = {3, 7, 1, 7, 5};
  CHECK(farthest_points(distances, 3) == std::vector<std::uint32_t>{1, 3, 4});
  CHECK(farthest_points(distances, 9) == std::vector<std::uint32_t>{1, 3, 4, 0, 2});
  CHECK(farthest_points(distances, 0).empty());
  CHECK(farthest_points({}, 4).empty());
}

TEST_CASE(
    "a spike is the highest vertex of a sheet, and a vertex without triangles has no height") {
  Mesh sheet = test::grid(20, 20);
  sheet.positions[10 * 21 + 7].z = 4;
  sheet.positions.push_back({50, 50, 50});
  const std::vector<double> heights = heights_of_vertices(sheet);
  CHECK(heights[10 * 21 + 7] == doctest::Approx(4));
  CHECK(std::max_element(heights.begin(), heights.end()) - heights.begin() == 10 * 21 + 7);
  CHECK(heights.back() == 0);
}

TEST_CASE("a small triangle gets few points, a large one 66 and those round the place") {
  std::vector<Vec3> points;
  append_points(k_large.positions, k_large.triangles[0], k_inside, {200, 5}, points);
  CHECK(points.size() == 3);
  points.clear();
  append_points(k_large.positions, k_large.triangles[0], k_inside, {50, 5}, points);
  CHECK(points.size() == 10);
  points.clear();
  append_points(k_large.positions, k_large.triangles[0], k_inside, {1, 6}, points);
  CHECK(points.size() == 66 + 49);
  CHECK(are_on(k_large, k_large.triangles[0], points));
  const auto near = std::count_if(points.begin(), points.end(), [](const Vec3& p) {
    return std::abs(p.x - 20) <= 6.0001 && std::abs(p.y - 30) <= 6.0001;
  });
  CHECK(near >= 49);
  points.clear();
  append_points(k_large.positions, k_large.triangles[0], k_corner, {1, 6}, points);
  CHECK(points.size() == 66 + 16);  // a quarter of these lies on the triangle
  CHECK(are_on(k_large, k_large.triangles[0], points));
}

TEST_CASE("no step and no area are no harm") {
  std::vector<Vec3> points;
  append_points(k_large.positions, k_large.triangles[0], k_inside, {0, 0}, points);
  CHECK(points.size() >= 66);
  const Mesh needle = {.positions = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, .triangles = {{0, 1, 2}}};
  append_points(needle.positions, needle.triangles[0], needle.positions, {0.01, 0.1}, points);
  CHECK(std::all_of(points.begin(), points.end(), [](const Vec3& p) { return is_finite(p); }));
}

TEST_CASE("points are taken of the triangles that the places lie on, and beside them") {
  const Mesh sheet = test::grid(30, 30);
  const std::vector<Vec3> points = {{4.3, 5.2, 0}, {20.7, 9.6, 0}, {1, 1, 7}};
  const std::vector<std::uint32_t> some = {0, 1};
  const PlacesOfPoints places(points, some);
  std::vector<Vec3> found;
  places.append_points_of(sheet.positions, sheet.triangles, {10, 10}, found);
  CHECK(found.size() >= 6);
  CHECK(found.size() <= 12);
  for (const Vec3& p : found) {
    CHECK((length(p - points[0]) < 1.5 || length(p - points[1]) < 1.5));
  }
}
