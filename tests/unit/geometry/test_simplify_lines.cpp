// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/simplify/simplify_clean.hpp"
#include "geometry/simplify/simplify_lines.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

constexpr int k_units = 24;

/// How many of the cube's faces a point of its surface lies on: 1 inside a face, 2 on an edge.
int faces_at(const std::array<int, 3>& p) {
  return static_cast<int>(
      std::count_if(p.begin(), p.end(), [](int c) { return c == 0 || c == k_units; }));
}

/// A cube with k_units units per side, rough on its faces but not on its edges.
Mesh rough_cube() {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> index;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [at, is_new] = index.try_emplace(p, static_cast<std::uint32_t>(index.size()));
    if (is_new) {
      const double rough =
          faces_at(p) > 1 ? 0 : 0.2 * std::sin(7.0 * p[0] + 5.0 * p[1] + 3.0 * p[2]);
      Vec3 position{p[0] * 1.0, p[1] * 1.0, p[2] * 1.0};
      if (p[0] == 0 || p[0] == k_units) position.x += rough;
      if (p[1] == 0 || p[1] == k_units) position.y += rough;
      if (p[2] == 0 || p[2] == k_units) position.z += rough;
      mesh.positions.push_back(position);
    }
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int level : {0, k_units}) {
      for (int u = 0; u < k_units; ++u) {
        for (int v = 0; v < k_units; ++v) {
          std::array<std::uint32_t, 4> corner{};
          for (int i = 0; i < 4; ++i) {
            std::array<int, 3> p{};
            p[axis] = level;
            p[(axis + 1) % 3] = u + (i == 1 || i == 2 ? 1 : 0);
            p[(axis + 2) % 3] = v + (i >= 2 ? 1 : 0);
            corner[static_cast<std::size_t>(i)] = vertex(p);
          }
          if (level == 0) std::swap(corner[1], corner[3]);
          mesh.triangles.push_back({corner[0], corner[1], corner[2]});
          mesh.triangles.push_back({corner[0], corner[2], corner[3]});
        }
      }
    }
  }
  return mesh;
}

bool is_cube_corner(Vec3 p) {
  const auto at_end = [](double c) { return c == 0 || c == k_units; };
  return at_end(p.x) && at_end(p.y) && at_end(p.z);
}

/// The length of the result's edges that are nearer than `near` to the cube's edges.
double length_on_cube_edges(const Mesh& mesh, double near) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i];
      const std::uint32_t b = t[(i + 1) % 3];
      if (a > b) continue;  // the other triangle has it the other way round
      const auto on_same = [&](double ca, double cb) {
        return std::abs(ca - cb) < near && (std::abs(ca) < near || std::abs(ca - k_units) < near);
      };
      const Vec3 p = mesh.positions[a];
      const Vec3 q = mesh.positions[b];
      const int faces =
          (on_same(p.x, q.x) ? 1 : 0) + (on_same(p.y, q.y) ? 1 : 0) + (on_same(p.z, q.z) ? 1 : 0);
      if (faces == 2) sum += length(q - p);
    }
  }
  return sum;
}

Mesh simplified(const Mesh& mesh, const LineOptions& lines, std::uint64_t triangles) {
  SimplifyOptions options;
  options.lines = lines;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({triangles});
  return simplifier.mesh();
}

std::set<std::array<double, 3>> points(const Mesh& mesh) {
  std::set<std::array<double, 3>> found;
  for (const Vec3 p : mesh.positions) found.insert({p.x, p.y, p.z});
  return found;
}

/// Two sheets that meet at y = 0 at an angle which fades along x: sharp at x = 0, none at x = 1.
Mesh fading_fold() {
  return grid(40, 40, [](double x, double y) { return std::abs(y - 0.5) * 2 * (1 - x); });
}

}  // namespace

TEST_CASE("creases are told by the angle between the triangles") {
  // Two triangles at the x axis, the second turned up by 30 degrees.
  const Vec3 at{0, 0, 0}, end{1, 0, 0}, right{0.5, -1, 0};
  const double turn = std::acos(-1.0) / 6;
  const Vec3 left{0.5, std::cos(turn), std::sin(turn)};
  CHECK(CreaseTest(29).is_crease(at, right, end, left));
  CHECK(!CreaseTest(31).is_crease(at, right, end, left));
  const Vec3 folded{0.5, -1, 0.1};
  CHECK(CreaseTest(120).is_crease(at, right, end, folded));
  CHECK(!CreaseTest(179.9).is_crease(at, right, end, folded));
  CHECK(!CreaseTest(1).is_crease(at, right, end, {0.5, 0, 0}));  // no area, no normal
}

TEST_CASE("flags tell creases and their corners") {
  const Mesh cube = rough_cube();
  Mesh mesh = cube;
  Adjacency adjacency;
  std::vector<std::uint8_t> flags = clean_surface(mesh, {}, adjacency).flags;
  CreaseLines(60, false).find(mesh, adjacency, flags);
  for (std::uint32_t v = 0; v < flags.size(); ++v) {
    const Vec3 p = mesh.positions[v];
    const auto whole = [](double c) { return static_cast<int>(std::lround(c)); };
    const int faces = faces_at({whole(p.x), whole(p.y), whole(p.z)});
    CHECK(line_rank(flags[v]) == faces - 1);
  }
}

TEST_CASE("the edges of a cube stay sharp with a crease angle") {
  const Mesh cube = rough_cube();
  const double edges = 12.0 * k_units;
  REQUIRE(length_on_cube_edges(cube, 1e-9) == doctest::Approx(edges));
  const Mesh kept = simplified(cube, {.crease_angle = 60}, 200);
  CHECK(kept.triangles.size() == 200);
  CHECK(is_clean(kept));
  // The faces are rough by 0.2.
  CHECK(length_on_cube_edges(kept, 0.05) > 0.95 * edges);
  CHECK(std::count_if(kept.positions.begin(), kept.positions.end(), is_cube_corner) == 8);
  const Mesh plain = simplified(cube, {}, 200);
  CHECK(length_on_cube_edges(plain, 0.05) < 0.5 * edges);
}

TEST_CASE("where a crease ends its last vertex stays") {
  const Mesh fold = fading_fold();
  const Mesh result = simplified(fold, {.crease_angle = 60}, 120);
  CHECK(is_clean(result));
  // Sharper than 60 degrees where 2 (1 - x) > tan(30 degrees); the flags follow it further.
  const auto is_kept = [](Vec3 p) { return p.y == 0.5 && p.x > 0.6 && p.x < 0.9; };
  CHECK(std::any_of(result.positions.begin(), result.positions.end(), is_kept));
  for (const Vec3 p : result.positions) {
    const double off = std::abs(p.y - 0.5);
    if (p.x < 0.6) CHECK((off < 0.002 || off > 0.02));
  }
}

TEST_CASE("preserved borders are as they came") {
  const Mesh mesh = wavy_grid(40, 40);
  const Mesh result = simplified(mesh, {.preserve_border = true}, 0);
  CHECK(is_clean(result));
  const auto left = points(result);
  std::size_t border = 0;
  for (const Vec3 p : mesh.positions) {
    if (p.x != 0 && p.x != 1 && p.y != 0 && p.y != 1) continue;
    ++border;
    CHECK(left.count({p.x, p.y, p.z}) == 1);
  }
  CHECK(border == 160);
  CHECK(result.triangles.size() < 400);
  CHECK(check(result).border_edges == 160);
}

TEST_CASE("creases are edges of more than the angle: right angles are none at 90 degrees") {
  // The edge along x between a flat triangle and one that is folded up by an angle.
  const auto is_crease = [](double threshold, Vec3 left) {
    return CreaseTest(threshold).is_crease({0, 0, 0}, {0.5, -1, 0}, {1, 0, 0}, left);
  };
  const Vec3 upright{0.5, 0, 1};
  CHECK_FALSE(is_crease(90, upright));
  CHECK(is_crease(89.999, upright));
  CHECK_FALSE(is_crease(90.001, upright));
  CHECK(is_crease(90, {0.5, -1e-9, 1}));
  for (const double angle : {10.0, 30.0, 45.0, 60.0, 80.0, 100.0, 135.0, 170.0}) {
    CAPTURE(angle);
    const double turn = angle * std::acos(-1.0) / 180;
    const Vec3 left{0.5, std::cos(turn), std::sin(turn)};
    CHECK(is_crease(angle * (1 - 1e-12), left));
    CHECK_FALSE(is_crease(angle * (1 + 1e-12), left));
  }
}

TEST_CASE("a crease angle that is none is refused") {
  SimplifyOptions options;
  for (const double angle : {-1.0, 180.0, std::nan("")}) {
    options.lines.crease_angle = angle;
    CHECK_THROWS_AS(Simplifier(sphere(2), options), UsageError);
  }
}

TEST_CASE("small components outlive the details of large ones") {
  Mesh mesh = sphere(6);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i < 20; ++i) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const Mesh crumb = sphere(1);
    for (const Vec3 p : crumb.positions) mesh.positions.push_back(p * 1e-3 + Vec3{3.0 + i, 0, 0});
    for (const Triangle& t : crumb.triangles) {
      mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
  }
  REQUIRE(first > 0);
  Simplifier simplifier(mesh, {});
  simplifier.reduce({1000});
  CHECK(simplifier.triangles() == 1000);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).euler == 2 * 21);
}

TEST_CASE("straight folds that are off by rounding go before small parts beside them") {
  constexpr std::uint32_t k_size = 60;
  Mesh mesh = grid(k_size, k_size, [](double x, double y) {
    return 0.3 * y + (std::lround(x * k_size) % 2 == 0 ? 0 : 0.01);
  });
  // Hexagonal bolts: caps of 4 triangles, 12 round the sides.
  const std::size_t first_bolt = mesh.positions.size();
  Mesh bolt;
  for (int side = 0; side < 6; ++side) {
    const double turn = side * std::numbers::pi / 3;
    for (const double z : {0.0, 1.0}) bolt.positions.push_back({std::cos(turn), std::sin(turn), z});
  }
  for (std::uint32_t side = 0; side < 6; ++side) {
    const std::uint32_t low = 2 * side;
    const std::uint32_t next = (low + 2) % 12;
    bolt.triangles.insert(bolt.triangles.end(), {{low, next, next + 1}, {low, next + 1, low + 1}});
    if (side == 0 || side == 5) continue;
    bolt.triangles.insert(bolt.triangles.end(), {{0, next, low}, {1, low + 1, next + 1}});
  }
  constexpr std::uint32_t k_bolts = 14;
  for (std::uint32_t i = 0; i < k_bolts * k_bolts; ++i) {
    Mesh small = bolt;
    for (Vec3& p : small.positions) p = p * 0.001;
    append(mesh, small, {0.05 + 0.07 * (i % k_bolts), 0.05 + 0.07 * (i / k_bolts), 0.5});
  }
  for (Vec3& p : mesh.positions) p = rounded(p * 10.0, PositionType::float32);
  SimplifyOptions options;
  options.positions = PositionType::float32;
  Simplifier result(mesh, options);
  const std::uint64_t goal = 20 * k_bolts * k_bolts + 500;
  result.reduce({goal});
  CHECK(result.triangles() == goal);
  const std::vector<Vec3> corners(mesh.positions.begin() + static_cast<long>(first_bolt),
                                  mesh.positions.end());
  CHECK(DistanceMeter(result.mesh(), 1).measure(corners).max < 1e-5);
}
