// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>
#include <set>

#include <doctest/doctest.h>

#include <meshfarm/geometry/crossings.hpp>

#include "geometry/triangle_crossing.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::uint64_t crossing(const Mesh& mesh) {
  const auto one = count_crossing_triangles(mesh, {.threads = 1});
  REQUIRE(one);
  CHECK(count_crossing_triangles(mesh, {.threads = 4}) == one);
  return *one;
}

/// Whether two triangles cross; checks that this is the same in any order of corners and triangles.
bool cross(const TriangleCorners& a, const TriangleCorners& b) {
  const auto turned = [](const TriangleCorners& t, std::size_t by, bool over) {
    TriangleCorners made{t[by], t[(by + 1) % 3], t[(by + 2) % 3]};
    if (over) std::swap(made[1], made[2]);
    return CrossingTriangle(made);
  };
  const bool found = do_cross(CrossingTriangle(a), CrossingTriangle(b));
  for (std::size_t i = 0; i < 36; ++i) {
    const CrossingTriangle x = turned(a, i % 3, i % 2 == 0);
    const CrossingTriangle y = turned(b, i / 6 % 3, i / 18 == 0);
    CHECK(do_cross(x, y) == found);
    CHECK(do_cross(y, x) == found);
  }
  return found;
}

std::uint64_t crossing_slowly(const Mesh& mesh) {
  std::vector<CrossingTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.emplace_back(
        TriangleCorners{mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  }
  std::set<std::size_t> found;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = i + 1; k < triangles.size(); ++k) {
      if (do_cross(triangles[i], triangles[k])) found.insert({i, k});
    }
  }
  return found.size();
}

Mesh shifted(Mesh mesh, Vec3 by) {
  for (Vec3& p : mesh.positions) p = p + by;
  return mesh;
}

/// A fan of triangles that share one corner.
Mesh fan(std::uint32_t count) {
  Mesh mesh{{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turn = 2 * std::acos(-1.0) * i / count;
    mesh.positions.push_back({std::cos(turn), std::sin(turn), 0});
    mesh.triangles.push_back({0, i + 1, (i + 1) % count + 1});
  }
  return mesh;
}

constexpr TriangleCorners k_flat = {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};

}  // namespace

TEST_CASE("crossings: triangles without a common corner") {
  CHECK(cross(k_flat, {Vec3{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}));        // goes through
  CHECK(cross(k_flat, {Vec3{1, -1, -1}, {1, 9, -1}, {1, 2, 5}}));      // cuts two sides
  CHECK(cross(k_flat, {Vec3{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}));         // a corner on it
  CHECK(cross(k_flat, {Vec3{2, 0, 0}, {2, -1, 1}, {2, -1, -1}}));      // a corner on its side
  CHECK(cross(k_flat, {Vec3{-1, -1, 0}, {9, 9, 0}, {4, 4, 5}}));       // a side lies on it
  CHECK_FALSE(cross(k_flat, {Vec3{1, 1, 1}, {2, 1, 1}, {1, 2, 2}}));   // above
  CHECK_FALSE(cross(k_flat, {Vec3{3, 3, -1}, {3, 3, 1}, {4, 4, 0}}));  // beside
  CHECK_FALSE(cross(k_flat, {Vec3{1, 1, 0x1p-60}, {1, 1, 1}, {2, 1, 1}}));
  CHECK_FALSE(cross(k_flat, {Vec3{2, 2 + 0x1p-50, 0}, {9, 9, 0}, {9, 9, 1}}));
}

TEST_CASE("crossings: triangles in one plane") {
  CHECK(cross(k_flat, {Vec3{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}));
  CHECK(cross(k_flat, {Vec3{1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}}));  // within
  CHECK(cross(k_flat, {Vec3{2, 2, 0}, {5, 2, 0}, {5, 5, 0}}));      // a corner on its side
  CHECK(cross(k_flat, {Vec3{-1, 0, 0}, {5, 0, 0}, {2, -3, 0}}));    // side on side
  CHECK_FALSE(cross(k_flat, {Vec3{3, 2, 0}, {5, 2, 0}, {5, 5, 0}}));
  CHECK_FALSE(cross(k_flat, {Vec3{4 + 0x1p-50, 0, 0}, {5, 0, 0}, {5, 5, 0}}));
}

TEST_CASE("crossings: triangles that have a corner in common meet at more than that, or not") {
  CHECK_FALSE(cross(k_flat, {Vec3{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}));
  CHECK_FALSE(cross(k_flat, {Vec3{0, 0, 0}, {1, 1, 1}, {2, 1, 1}}));
  CHECK_FALSE(cross(k_flat, {Vec3{0, 0, 0}, {-4, 0, 0}, {0, -4, 0}}));  // in one plane, opposite
  CHECK_FALSE(cross(k_flat, {Vec3{0, 0, 0}, {-4, 1, 0}, {0, -4, 0}}));
  CHECK(cross(k_flat, {Vec3{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}));
  CHECK(cross(k_flat, {Vec3{0, 0, 0}, {8, 8, 1}, {8, 8, -1}}));
  CHECK(cross(k_flat, {Vec3{0, 0, 0}, {1, 1, 0}, {1, 1, 5}}));   // a side on it
  CHECK(cross(k_flat, {Vec3{0, 0, 0}, {1, 2, 0}, {2, 1, 0}}));   // in one plane
  CHECK(cross(k_flat, {Vec3{0, 0, 0}, {2, 0, 0}, {2, -1, 0}}));  // side on side
  CHECK_FALSE(cross(k_flat, {Vec3{0, 0, 0}, {1, -0x1p-50, 1}, {1, -0x1p-50, -1}}));
}

TEST_CASE("crossings: triangles that have a side in common are folded flat, or not") {
  CHECK_FALSE(cross(k_flat, {Vec3{4, 0, 0}, {0, 4, 0}, {4, 4, 0}}));
  CHECK_FALSE(cross(k_flat, {Vec3{4, 0, 0}, {0, 4, 0}, {1, 1, 0x1p-60}}));
  CHECK(cross(k_flat, {Vec3{4, 0, 0}, {0, 4, 0}, {1, 1, 0}}));
  CHECK(cross(k_flat, k_flat));
  CHECK_FALSE(cross(k_flat, {Vec3{1, 1, -1}, {1, 1, 1}, {1, 1, 3}}));  // without area
  CHECK_FALSE(cross(k_flat, {Vec3{0, 0, 0}, {0, 0, 0}, {1, 1, 0}}));
}

TEST_CASE("crossings: surfaces that do not cross themselves have none") {
  CHECK(crossing({}) == 0);
  CHECK(crossing(test::grid(1, 1)) == 0);
  CHECK(crossing(test::icosphere(3)) == 0);
  CHECK(crossing(test::torus(40, 20)) == 0);
  CHECK(crossing(test::grid(30, 30)) == 0);
  CHECK(crossing(test::bow_tie()) == 0);
  CHECK(crossing(test::three_fans()) == 0);
  CHECK(crossing(test::touching_row(5, false)) == 0);
  CHECK(crossing(test::touching_row(5, true)) == 0);
  Mesh far = test::torus(20, 20);
  for (Vec3& p : far.positions) p = p * 1e-3 + Vec3{1e6, -1e6, 1e6};
  CHECK(crossing(far) == 0);
}

TEST_CASE("crossings: two quads that cut each other, and a hole that is cut out") {
  const double tilt = 0.3;
  Mesh quads = test::grid(1, 1);
  Mesh other{{{0.5, -1, -1}, {0.5, 2, -1 + tilt}, {0.5, 2, 1}, {0.5, -1, 1}},
             {{0, 1, 2}, {0, 2, 3}}};
  test::append(quads, other);
  CHECK(crossing(quads) == 4);
  // A needle through one of 1,800 triangles.
  Mesh sheet = test::grid(30, 30);
  test::append(sheet, {{{10.7, 10.2, -1}, {10.7, 10.2, 1}, {10.71, 10.21, 1}}, {{0, 1, 2}}});
  CHECK(crossing(sheet) == 2);
}

TEST_CASE("crossings: two spheres cross in a ring, as all pairs tell") {
  Mesh spheres = test::icosphere(3);
  test::append(spheres, shifted(test::icosphere(3), {0.9, 0.3, 0.1}));
  const std::uint64_t all = crossing(spheres);
  CHECK(all == crossing_slowly(spheres));
  // A circle on each sphere: some 40 triangles across, each cut once or twice.
  CHECK(all > 100);
  CHECK(all < 400);
  Mesh soup;
  for (const auto& [a, b, c] : spheres.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : {a, b, c}) soup.positions.push_back(spheres.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  CHECK(crossing(soup) == all);
}

TEST_CASE("crossings: triangles between points of a lattice, as all pairs tell") {
  std::mt19937 random(3);
  for (const int size : {3, 12}) {
    std::uniform_int_distribution<int> draw(0, size);
    Mesh mesh;
    for (std::uint32_t i = 0; i < 120; ++i) {
      const Vec3 at{static_cast<double>(draw(random)), static_cast<double>(draw(random)),
                    static_cast<double>(draw(random))};
      for (int k = 0; k < 3; ++k) {
        mesh.positions.push_back(at + Vec3{static_cast<double>(draw(random) % 3),
                                           static_cast<double>(draw(random) % 3),
                                           static_cast<double>(draw(random) % 3)});
      }
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    CHECK(crossing(mesh) == crossing_slowly(mesh));
  }
}

TEST_CASE("crossings: more triangles at one place than anyone would wait for are not counted") {
  const Mesh crowd = fan(500);  // 124,750 pairs, and a few more in leaves
  CHECK(crossing(crowd) == 0);
  CHECK_FALSE(count_crossing_triangles(crowd, {.threads = 2, .pairs = 100'000}));
  CHECK(count_crossing_triangles(crowd, {.threads = 2, .pairs = 150'000}));
  CHECK(count_crossing_triangles(crowd, {.pairs = 0, .pairs_a_triangle = 300}));
}
