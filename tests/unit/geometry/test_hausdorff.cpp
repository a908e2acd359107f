// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>

#include "geometry/piece_bounder.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

constexpr double k_gap = 1e-3;

Mesh put(Mesh mesh, Vec3 by, double scale = 1) {
  for (Vec3& p : mesh.positions) p = p * scale + by;
  return mesh;
}

DistanceBounds bounds_of(const Mesh& from, const Mesh& to, double gap = k_gap) {
  HausdorffOptions options;
  options.gap = gap;
  options.threads = 2;
  return bound_distance(from, to, options);
}

bool is_within(const Mesh& from, const Mesh& to, double distance) {
  const TriangleIndex index(to, 1);
  const bool is = is_within(from, index, distance, 2);
  CHECK(is == find_beyond(from.positions, from.triangles, index, distance, 2).empty());
  return is;
}

/// Checks that the bounds enclose the known distance and are about `gap` apart at most.
void check_bounds(const DistanceBounds& found, double known, double gap = k_gap) {
  CHECK(found.lower <= known);
  CHECK(found.upper >= known);
  CHECK(found.upper - found.lower <= gap * 1.001);
}

/// A single right triangle with legs of length `leg`.
Mesh large_triangle(double leg) {
  return {{{0, 0, 0}, {leg, 0, 0}, {0, leg, 0}}, {{0, 1, 2}}};
}

/// Triangles of all sizes in the unit cube, with needles, segments and points among them.
Mesh mixed_triangles(std::uint32_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double size = i % 5 == 0 ? 0.8 : 0.1;
    const Vec3 a = point();
    const Vec3 b = i % 13 == 2 ? a : a + (point() - a) * size;
    const Vec3 c = i % 7 == 3   ? a + (b - a) * 0.3
                   : i % 7 == 5 ? b + (a - b) * 1e-12
                                : a + (point() - a) * size;
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// The greatest distance of points on a grid in each triangle, sides included.
double sampled_distance(const Mesh& from, const Mesh& to) {
  constexpr int k_steps = 40;
  std::vector<Vec3> points;
  for (const Triangle& t : from.triangles) {
    const auto [a, b, c] = corners_of(from.positions, t);
    for (int i = 0; i <= k_steps; ++i) {
      for (int j = 0; i + j <= k_steps; ++j) {
        points.push_back(a + (b - a) * (1.0 * i / k_steps) + (c - a) * (1.0 * j / k_steps));
      }
    }
  }
  return DistanceMeter(to, 1).measure(points).max;
}

}  // namespace

TEST_CASE("hausdorff: the same plane in other triangles is at no distance") {
  const Mesh fine = test::grid(16, 16);
  const Mesh coarse = put(test::grid(1, 1), {0, 0, 0}, 16);
  check_bounds(bounds_of(fine, coarse), 0);
  check_bounds(bounds_of(coarse, fine, 0.05), 0, 0.05);
  CHECK(bounds_of(fine, fine).upper < 1e-12);
}

TEST_CASE("hausdorff: a flat surface is proven to lie within any distance of its plane") {
  const Mesh plane = test::grid(16, 16);
  for (const double distance : {1e-3, 1e-6, 1e-9, 1e-11}) {
    CHECK(is_within(put(large_triangle(14), {0.3, 0.6, 0}), plane, distance));
    CHECK(is_within(put(large_triangle(14), {0.3, 0.6, distance / 2}), plane, distance));
    CHECK(!is_within(put(large_triangle(14), {0.3, 0.6, 2 * distance}), plane, distance));
  }
}

TEST_CASE("hausdorff: parallel sheets are as far apart as they are") {
  const Mesh sheet = test::grid(12, 9);
  for (const double height : {0.01, 0.3, 40.0}) {
    const Mesh above = put(sheet, {0, 0, height});
    check_bounds(bounds_of(sheet, above), height);
    check_bounds(bounds_of(put(test::grid(3, 3), {1, 1, height}, 2), sheet), height);
    CHECK(is_within(sheet, above, height * 1.01));
    CHECK_FALSE(is_within(sheet, above, height * 0.999));
  }
}

TEST_CASE("hausdorff: what one of the two has more counts in one direction only") {
  const Mesh whole = test::grid(8, 4);
  const Mesh half = test::grid(4, 4);
  CHECK(bounds_of(half, whole).upper < 1e-12);
  check_bounds(bounds_of(whole, half), 4);
}

TEST_CASE("hausdorff: corners that lie on a surface do not prove the triangle between them") {
  // Across a slot, farthest in the middle.
  Mesh slotted = test::grid(4, 8);
  const Mesh right = put(test::grid(4, 8), {7, 0, 0});
  test::append(slotted, right);
  const Mesh cover = {{{4, 1, 0}, {7, 4, 0}, {4, 7, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  check_bounds(bounds_of(cover, slotted), 1.5);
  // Over a valley: the slopes are at 45 degrees, so the middle is 5 / sqrt(2) away.
  const Mesh valley = {{{0, 0, 5}, {0, 10, 5}, {5, 0, 0}, {5, 10, 0}, {10, 0, 5}, {10, 10, 5}},
                       {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}}};
  const Mesh lid = {{{0, 0, 5}, {10, 5, 5}, {0, 10, 5}}, {{0, 1, 2}}};
  check_bounds(bounds_of(lid, valley), 5 / std::sqrt(2.0));
}

TEST_CASE("hausdorff: a sphere of few triangles against one of many") {
  const Mesh coarse = test::icosphere(1);
  const Mesh fine = test::icosphere(4);
  const auto deepest = [](const Mesh& mesh) {  // below the sphere, in the middle of a triangle
    double depth = 0;
    for (const Triangle& t : mesh.triangles) {
      const auto [a, b, c] = corners_of(mesh.positions, t);
      const Vec3 normal = cross(b - a, c - a);
      depth = std::max(depth, 1 - dot(a, normal) / length(normal));
    }
    return depth;
  };
  const double most = deepest(coarse), least = most - deepest(fine);
  const DistanceBounds inwards = bounds_of(coarse, fine, 1e-4);
  CHECK(inwards.upper >= least);
  CHECK(inwards.lower <= most);
  CHECK(inwards.upper <= most + 1e-4);
  const DistanceBounds outwards = bounds_of(fine, coarse, 1e-4);
  CHECK(outwards.upper >= least);
  CHECK(outwards.upper <= most + 1e-4);
}

TEST_CASE("hausdorff: no sample is beyond the bounds, whatever the triangles are like") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const Mesh from = mixed_triangles(60, seed), to = mixed_triangles(50, seed + 100);
    const DistanceBounds found = bounds_of(from, to);
    CHECK(found.upper - found.lower <= k_gap * 1.001);
    const double sampled = sampled_distance(from, to);
    CHECK(sampled <= found.upper);
    CHECK(sampled >= found.lower - 0.02);
    CHECK(is_within(from, to, found.upper * 1.002));
    CHECK_FALSE(is_within(from, to, found.lower * 0.999));
  }
}

TEST_CASE("hausdorff: triangles beyond a distance are found, and no others") {
  Mesh bent = test::grid(10, 10);
  for (Vec3& p : bent.positions) p.z = std::max(0.0, p.x - 6) * 0.5;
  const Mesh flat = test::grid(10, 10);
  const TriangleIndex index(flat, 1);
  const auto beyond = find_beyond(bent.positions, bent.triangles, index, 0.75, 3);
  std::vector<std::uint32_t> known;
  for (std::uint32_t i = 0; i < bent.triangles.size(); ++i) {
    const auto [a, b, c] = corners_of(bent.positions, bent.triangles[i]);
    if (std::max({a.z, b.z, c.z}) > 0.75) known.push_back(i);
  }
  CHECK(known.size() == 60);
  CHECK(beyond == known);
}

TEST_CASE("hausdorff: triangles with two corners at one place are dropped, with their columns") {
  Mesh mesh = test::octahedron();
  mesh.positions.push_back(mesh.positions[0]);
  mesh.triangles.insert(mesh.triangles.begin() + 3, {0, 6, 2});
  mesh.triangles.push_back({1, 1, 4});
  mesh.columns.labels = {0, 1, 2, 99, 3, 4, 5, 6, 7, 99};
  drop_coincident_corners(mesh);
  CHECK(mesh.triangles == test::octahedron().triangles);
  CHECK(mesh.columns.labels == std::vector<Label>{0, 1, 2, 3, 4, 5, 6, 7});
}

TEST_CASE("hausdorff: what is enough is not told apart, and saves the rest") {
  const Mesh sheet = test::grid(10, 10);
  const Mesh above = put(sheet, {0.3, 0.2, 0.25});
  HausdorffOptions options;
  options.gap = 1e-6;
  options.enough = 1;
  const DistanceBounds found = bound_distance(sheet, above, options);
  CHECK(found.upper <= 1);
  CHECK(found.upper >= 0.25);
  CHECK(found.lower <= 0.25 * std::sqrt(3.0));
}

TEST_CASE("hausdorff: a triangle has no more pieces than allowed, and the bounds still hold") {
  const Mesh fine = test::grid(64, 64);
  const Mesh large = put(large_triangle(60), {1, 1, 0});
  HausdorffOptions options;
  options.gap = 1e-9;
  options.most_pieces = 100;
  const DistanceBounds found = bound_distance(large, fine, options);
  CHECK(found.lower == 0);
  CHECK(found.upper > 1e-9);
  CHECK(found.upper < 30);
}

TEST_CASE("hausdorff: the bounds do not depend on threads") {
  const Mesh from = test::icosphere(4);
  const Mesh to = put(test::icosphere(3), {0.01, 0, 0});
  HausdorffOptions options;
  options.relative_gap = 0.01;
  options.threads = 1;
  const DistanceBounds one = bound_distance(from, to, options);
  options.threads = 4;
  const DistanceBounds four = bound_distance(from, to, options);
  CHECK(one.lower == four.lower);
  CHECK(one.upper == four.upper);
  CHECK(one.upper <= one.lower * 1.0101);
}

TEST_CASE("hausdorff: far from the origin the bounds allow for rounding") {
  const Vec3 far{3e9, -1e9, 7e8};
  const Mesh from = put(test::icosphere(3), far);
  const Mesh to = put(test::icosphere(3), far + Vec3{0, 0, 0.125});
  const DistanceBounds found = bounds_of(from, to, 1e-2);
  CHECK(found.lower <= 0.125);
  CHECK(found.upper >= 0.125 - 1e-6);
  CHECK(found.upper <= 0.14);
}

TEST_CASE("hausdorff: nothing, segments and points") {
  const Mesh nothing;
  const Mesh sheet = test::grid(4, 4);
  CHECK(bound_distance(nothing, sheet, {}).upper == 0);
  CHECK(bound_distance(nothing, nothing, {}).upper == 0);
  CHECK(std::isinf(bound_distance(sheet, nothing, {}).lower));
  const Mesh segment = {{{0, 0, 1}, {4, 4, 3}}, {{0, 0, 1}}};
  check_bounds(bounds_of(segment, sheet), 3);
  const Mesh point = {{{2, 2, 5}}, {{0, 0, 0}}};
  check_bounds(bounds_of(point, sheet), 5);
  check_bounds(bounds_of(sheet, point), std::sqrt(33.0));
}

TEST_CASE("hausdorff: the distance to a needle is never told too small") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = point(), b = point();
    const double thin = std::pow(10.0, -3 - i % 16);
    const CornerPoints needle = {a, b, a + (b - a) * 0.5 + point() * thin};
    const Vec3 p = point();
    const Vec3 ab = b - a;
    const double along = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
    const double to_segment = length(p - (a + ab * along));
    CHECK(distance_above(p, needle) >= to_segment - 2 * thin - 1e-14);
    CHECK(distance_above(p, needle) <= to_segment + 1e-14);
  }
}
