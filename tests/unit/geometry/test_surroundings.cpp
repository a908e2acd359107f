// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/bvh.hpp"
#include "geometry/simplify/surroundings.hpp"

namespace meshfarm::test {
namespace {

/// Scattered triangles that share nothing.
Mesh lonely_triangles(std::uint32_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0, 10);
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 at{anywhere(random), anywhere(random), anywhere(random)};
    const std::uint32_t v = 3 * i;
    mesh.positions.insert(mesh.positions.end(), {at, at + Vec3{0.1, 0, 0}, at + Vec3{0, 0.1, 0}});
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

/// `count` of them, none merged yet.
struct LonelyPieces {
  explicit LonelyPieces(std::uint32_t count)
      : mesh(lonely_triangles(count)), target(mesh.positions.size()) {
    std::iota(target.begin(), target.end(), 0U);
    keep(mesh.triangles);
  }
  void keep(const std::vector<Triangle>& left) {
    adjacency.build(left, mesh.positions.size(), mesh.columns);
  }
  /// The squared distance found from `from` for the first piece.
  double found_from(Vec3 from) {
    const std::vector<std::uint32_t> without = {0, 1, 2};
    return surroundings.squared_distance({mesh.positions, target, &adjacency}, {from, {}, without});
  }

  Mesh mesh;
  std::vector<std::uint32_t> target;
  Adjacency adjacency;
  Surroundings surroundings;
};

double nearest_other(const Mesh& mesh, std::uint32_t piece) {
  double least = HUGE_VAL;
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == 3 * piece) continue;
    const auto& [a, b, c] = t;
    least = std::min(least, squared_distance(mesh.positions[3 * piece], mesh.positions[a],
                                             mesh.positions[b], mesh.positions[c]));
  }
  return least;
}

TEST_CASE("what is found of a piece is not taken for its tip") {
  Mesh mesh;
  mesh.positions = {{0, 0, 3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  std::vector<std::uint32_t> target(4);
  std::iota(target.begin(), target.end(), 0U);
  Adjacency adjacency;
  adjacency.build(mesh.triangles, 4, mesh.columns);
  Surroundings surroundings;
  const auto found = [&](const std::vector<std::uint32_t>& without) {
    return surroundings.squared_distance({mesh.positions, target, &adjacency},
                                         {{0, 0, 2}, {}, without});
  };
  CHECK(std::isinf(found({0, 1, 2, 3})));
  CHECK(found({0}) == doctest::Approx(4));
  CHECK(std::isinf(found({0, 1, 2, 3})));
}

TEST_CASE("the nearest that is left is found, however many pieces are gone") {
  Mesh mesh = lonely_triangles(400);
  std::vector<std::uint32_t> target(mesh.positions.size());
  std::iota(target.begin(), target.end(), 0U);
  Surroundings surroundings;
  Adjacency adjacency;
  while (!mesh.triangles.empty()) {
    adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
    for (const Triangle& t : mesh.triangles) {
      const std::vector<std::uint32_t> without(t.begin(), t.end());
      const double found = surroundings.squared_distance({mesh.positions, target, &adjacency},
                                                         {mesh.positions[t[0]], {}, without});
      const double wanted = nearest_other(mesh, t[0] / 3);
      CHECK((found == wanted || found == doctest::Approx(wanted).epsilon(1e-12)));
    }
    mesh.triangles.resize(2 * mesh.triangles.size() / 3);
  }
}

TEST_CASE("what was found holds until the nearest is gone") {
  Mesh mesh = lonely_triangles(300);
  std::vector<std::uint32_t> target(mesh.positions.size());
  std::iota(target.begin(), target.end(), 0U);
  Adjacency adjacency;
  Surroundings remembers;
  while (!mesh.triangles.empty()) {
    adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
    const ShrinkingMesh shrinking{mesh.positions, target, &adjacency};
    Surroundings fresh;
    for (const Triangle& t : mesh.triangles) {
      const std::vector<std::uint32_t> without(t.begin(), t.end());
      std::vector<Vec3> corners;
      for (const std::uint32_t v : t) corners.push_back(mesh.positions[v]);
      const Surroundings::Lost lost{{}, corners, without};
      const double wanted = fresh.squared_distance(shrinking, lost);
      for (int i = 0; i < 2; ++i) CHECK(remembers.squared_distance(shrinking, lost) == wanted);
    }
    mesh.triangles.resize(2 * mesh.triangles.size() / 3);
  }
}

TEST_CASE("what is long is as far as its points are, in the mean") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {9, 0, 0}, {0, 1, 0}, {0, 0, 2}, {0, 1, 2}, {1, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  std::vector<std::uint32_t> target(mesh.positions.size());
  std::iota(target.begin(), target.end(), 0U);
  Adjacency adjacency;
  adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
  const std::vector<std::uint32_t> without = {0, 1, 2};
  const std::vector<Vec3> points = {{0, 0, 0}, {7, 0, 0}};  // 2 and |(6, 0, -2)| from the other
  Surroundings surroundings;
  const ShrinkingMesh shrinking{mesh.positions, target, &adjacency};
  CHECK(surroundings.squared_distance(shrinking, {{3, 0, 0}, points, without}) ==
        doctest::Approx((4 + 40) / 2.0));
}

TEST_CASE("a large triangle is near wherever it is, until it is gone") {
  Mesh mesh = lonely_triangles(50);  // within 10 of the origin
  mesh.positions.insert(mesh.positions.end(), {{20, 20, 0}, {120, 20, 0}, {20, 120, 0}});
  mesh.triangles.push_back({150, 151, 152});
  std::vector<std::uint32_t> target(mesh.positions.size());
  std::iota(target.begin(), target.end(), 0U);
  Adjacency adjacency;
  adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
  Surroundings surroundings;
  const auto found = [&](Vec3 from, const std::vector<std::uint32_t>& without) {
    return surroundings.squared_distance({mesh.positions, target, &adjacency}, {from, {}, without});
  };
  for (const double x : {25.0, 40.0, 50.0}) {
    CHECK(found({x, 30, 0.5}, {}) == doctest::Approx(0.25));
    CHECK(found({x, 30, 0.5}, {150, 151, 152}) > 100);
  }
  mesh.triangles.pop_back();
  adjacency.build(mesh.triangles, mesh.positions.size(), mesh.columns);
  CHECK(found({40, 40, 0.5}, {}) > 100);
}

TEST_CASE("what a vertex has become stands where the vertex was") {
  LonelyPieces pieces(3);
  const auto found = [&] { return pieces.found_from(pieces.mesh.positions[5]); };
  CHECK(found() == 0);
  pieces.target[5] = 3;
  CHECK(found() == 0);
  // Its piece is gone: the same is found each time.
  pieces.keep({pieces.mesh.triangles[0], pieces.mesh.triangles[2]});
  const double gone = found();
  CHECK(gone > 0);
  for (int i = 0; i < 1000; ++i) CHECK(found() == gone);
}

}  // namespace
}  // namespace meshfarm::test
