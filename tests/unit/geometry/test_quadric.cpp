// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/collapse_star.hpp"
#include "geometry/simplify/quadric.hpp"
#include "geometry/simplify/simplify_cost.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;

namespace {

/// Planes through a vertex, nearly those of a surface whose normal is z.
Quadric random_planes(simplify_test::Random& random, double roughness) {
  Quadric q;
  for (int i = 0; i < 6; ++i) {
    const Vec3 n{roughness * (random.unit() - 0.5), roughness * (random.unit() - 0.5), 1};
    q.add(n * (1 / length(n)), 0.5 + random.unit());
  }
  return q;
}

}  // namespace

TEST_CASE("a quadric is the squared distance to its planes") {
  Quadric q;
  q.add({0, 0, 1}, 2);
  q.add({0.6, 0.8, 0}, 1);
  const Vec3 x{1, 2, 3};
  CHECK(dot(q * x, x) == doctest::Approx(2 * 9 + 2.2 * 2.2));
  CHECK(q.trace() == doctest::Approx(3));
}

TEST_CASE("solve inverts, and gives zero where there is nothing to invert") {
  Quadric q;
  q.add({1, 0, 0}, 2);
  q.add({0, 1, 0}, 3);
  q.add({0.6, 0, 0.8}, 4);
  const Vec3 x = solve(q, 0, q * Vec3{5, -6, 7});
  CHECK(x.x == doctest::Approx(5));
  CHECK(x.y == doctest::Approx(-6));
  CHECK(x.z == doctest::Approx(7));
  CHECK(solve({}, 0, {1, 1, 1}) == Vec3{});
}

TEST_CASE("an edge quadric finds the corner of three planes") {
  EdgeQuadric q;
  q.squared_length = 4;
  const Vec3 corner{0.3, -0.2, 0.5};
  for (const Vec3 n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    Quadric plane;
    plane.add(n, 1);
    q.add(plane, corner);
  }
  CHECK(length(q.best() - corner) < 1e-4);
  CHECK(q.cost(corner) == 0);
  CHECK(q.cost(corner + Vec3{0, 2, 0}) == doctest::Approx(4));
}

TEST_CASE("an edge quadric of one plane stays in the middle") {
  EdgeQuadric q;
  q.squared_length = 4;
  Quadric plane;
  plane.add({0, 0, 1}, 1);
  q.add(plane, {1, 0, 0.25});
  const Vec3 best = q.best();
  CHECK(best.x == 0);
  CHECK(best.y == 0);
  CHECK(best.z == doctest::Approx(0.25).epsilon(1e-4));
}

TEST_CASE("area that is lost or gained costs") {
  EdgeQuadric q;
  q.squared_length = 2;
  q.a.add({0, 0, 1}, 1);
  CHECK(q.cost_of_lost_area(3) == doctest::Approx(4.8));
  CHECK(q.cost_of_lost_area(-3) == doctest::Approx(1.2));
}

TEST_CASE("a border plane stands on the edge, perpendicular to the triangle") {
  Quadric q;
  add_line_plane(q, {0, 0, 5}, {2, 0, 0});
  CHECK(dot(q * Vec3{7, 0, 9}, Vec3{7, 0, 9}) == 0);
  CHECK(dot(q * Vec3{0, 1, 0}, Vec3{0, 1, 0}) == doctest::Approx(3 * 4));
  Quadric none;
  add_line_plane(none, {0, 0, 0}, {2, 0, 0});
  CHECK(none.trace() == 0);
}

TEST_CASE("borders are light but at their corners") {
  const auto between = [](double degrees, double length) {
    const double angle = degrees * std::numbers::pi / 180;
    return border_weight_between({3, 0, 0}, Vec3{std::cos(angle), std::sin(angle), 0} * length);
  };
  for (const double length : {0.1, 10.0}) {
    CHECK(between(180, length) == 0.1);
    CHECK(between(121, length) == 0.1);
    CHECK(between(119, length) == 1);
    CHECK(between(90, length) == 1);
    CHECK(between(20, length) == 1);
  }
}

TEST_CASE("a star sums the planes of its triangles, and those of no area add nothing") {
  simplify_test::Random random(11);
  const auto point = [&] { return Vec3{random.unit(), random.unit(), random.unit()}; };
  const Vec3 middle{5, 6, 7};
  const Vec3 half{0.5, 0.25, 0};
  CollapseStar star;
  star.clear(middle, half);
  EdgeQuadric wanted;
  for (const double side : {-1.0, 1.0, 1.0}) {
    const Vec3 p = point();
    const Vec3 q = point();
    const Vec3 end = half * side;
    const Vec3 n = cross(p - end, q - end);
    Quadric plane;
    plane.add(n, 0.5 / length(n));
    wanted.add(plane, end);
    star.add({middle + p, middle + q, middle + p, middle + p}, CollapseStar::Pair{side, -side});
  }
  EdgeQuadric sum;
  star.sum_planes(sum);
  CHECK(sum.a.trace() == doctest::Approx(wanted.a.trace()));
  CHECK(sum.a.xy == doctest::Approx(wanted.a.xy));
  CHECK(sum.a.yz == doctest::Approx(wanted.a.yz));
  CHECK(sum.b.x == doctest::Approx(wanted.b.x));
  CHECK(sum.b.z == doctest::Approx(wanted.b.z));
  CHECK(sum.c == doctest::Approx(wanted.c));
}

TEST_CASE("a star tells the area that is lost, and refuses turned triangles") {
  // w - n - e
  // | a - b |
  // 1 - s - 2
  const Vec3 a{-1, 0, 0};
  const Vec3 b{1, 0, 0};
  const Vec3 n{0, 2, 0};
  const Vec3 s{0, -2, 0};
  const Vec3 w{-3, 2, 0};
  const Vec3 e{3, 2, 0};
  const Vec3 w1{-3, -2, 0};
  const Vec3 e2{3, -2, 0};
  CollapseStar star;
  star.clear({}, b);
  star.add({s, b, b, n}, CollapseStar::Pair{-1, -1});
  star.add({n, w, w, w1}, CollapseStar::Pair{-1, -1});
  star.add({w1, s, s, e2}, CollapseStar::Pair{-1, 1});
  star.add({e2, e, e, n}, CollapseStar::Pair{1, 1});
  EdgeQuadric quadric;
  star.sum_planes(quadric);
  CHECK(quadric.a.zz == doctest::Approx(24));
  constexpr std::uint32_t k_kept = 6;
  REQUIRE(star.lost_area(k_kept, {}).has_value());
  CHECK(*star.lost_area(k_kept, {}) == doctest::Approx(0));
  CHECK(*star.lost_area(k_kept, {0, 0, 1}) < -1);
  CHECK(!star.lost_area(k_kept, a * 4).has_value());
  CHECK(!star.lost_area(k_kept, w).has_value());
  CHECK(!star.lost_area(k_kept, {0, 3, 0}).has_value());
}

TEST_CASE("a tip that goes beyond all round it costs the area gained as far out as it goes") {
  const Vec3 half{0, 0, 1};  // from -1 to 1
  CollapseStar star;
  star.clear({}, half);
  const Vec3 p{1, 0, -2};
  const Vec3 q{0, 1, -2};
  star.add({p, half, half, q}, CollapseStar::Pair{-1, -1});
  star.add({q, p, q, p}, CollapseStar::Pair{-1, -1});
  constexpr std::uint32_t k_kept = 2;
  const double gained = 0.5;
  const double near = star.cost_of_protruding(1, k_kept, {0, 0, 1.5}, -gained);
  CHECK(near > 0);
  CHECK(star.cost_of_protruding(1, k_kept, {0, 0, 2}, -gained) == doctest::Approx(4 * near));
  CHECK(star.cost_of_protruding(1, k_kept, {0, 0, 2}, -2 * gained) == doctest::Approx(8 * near));
  CHECK(star.cost_of_protruding(1, k_kept, {0, 0, 2}, gained) == 0);  // area that is lost
  CHECK(star.cost_of_protruding(1, k_kept, {9, 9, 0.9}, -gained) == 0);
  // The other end is not a tip: its neighbours lie farther out.
  CHECK(star.cost_of_protruding(1, k_kept, {0, 0, -1.5}, -gained) == 0);
  CHECK(star.cost_of_protruding(1, k_kept, {0, 0, -2.5}, -gained) == doctest::Approx(near));
}

TEST_CASE("adjacency lists each vertex's corners in triangle order") {
  // 3 - 2
  // | / |
  // 0 - 1
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  Adjacency adjacency;
  adjacency.build(triangles, 5);
  CHECK(adjacency.vertices() == 5);
  REQUIRE(adjacency.count(0) == 2);
  CHECK(adjacency.at(0)[0].next == 1);
  CHECK(adjacency.at(0)[0].prev == 2);
  CHECK(adjacency.at(0)[1].next == 2);
  CHECK(adjacency.at(0)[1].prev == 3);
  CHECK(adjacency.count(1) == 1);
  CHECK(adjacency.at(2).size() == 2);
  CHECK(adjacency.at(4).empty());
  int ends = 0;
  for_border_edges(adjacency.at(0), [&](const Corner&, std::uint32_t end) { ends += 1 << end; });
  CHECK(ends == (1 << 1) + (1 << 3));
}

TEST_CASE("ranking agrees with the cost of the best position") {
  simplify_test::Random random(7);
  EdgeCosts costs;
  for (const double roughness : {1.0, 0.1, 0.02}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::vector<EdgeQuadric> exact(EdgeCosts::k_size);
      for (std::size_t i = 0; i < EdgeCosts::k_size; ++i) {
        const Vec3 half{random.unit() - 0.5, random.unit() - 0.5, 0.1 * random.unit()};
        const Quadric a = random_planes(random, roughness);
        const Quadric b = random_planes(random, roughness);
        exact[i].squared_length = 4 * squared_length(half);
        exact[i].add(a, half * -1.0);
        exact[i].add(b, half);
        costs.put(i, FloatQuadric(a), FloatQuadric(b), half);
      }
      costs.compute();
      for (std::size_t i = 0; i < EdgeCosts::k_size; ++i) {
        const Vec3 x = exact[i].best();
        const double trace = exact[i].a.trace();
        const double least = exact[i].cost(x) + 1e-5 * trace * squared_length(x);
        const double preference = 1e-6 * trace * exact[i].squared_length;
        CHECK(costs.get(i).ranking == doctest::Approx(least + preference).epsilon(0.01));
        CHECK(costs.get(i).least <= least);
        CHECK(costs.get(i).least >= least * 0.99 - 2 * preference);
      }
    }
  }
}

TEST_CASE("what floats are too rough for is told finely") {
  simplify_test::Random random(11);
  EdgeCosts costs;
  for (const double roughness : {1e-2, 1e-5, 1e-7}) {
    for (std::size_t i = 0; i < EdgeCosts::k_size; ++i) {
      const Vec3 half{random.unit() - 0.5, random.unit() - 0.5, roughness * random.unit()};
      const Quadric a = random_planes(random, roughness);
      const Quadric b = random_planes(random, roughness);
      EdgeQuadric exact;
      exact.squared_length = 4 * squared_length(half);
      exact.add(a, half * -1.0);
      exact.add(b, half);
      costs.put(i, FloatQuadric(a), FloatQuadric(b), half);
      costs.compute(true);
      const EdgeCost fine = fine_cost(a, b, half);
      CHECK(costs.get(i).is_rough == (roughness < 1e-3));
      CHECK(fine.least <= exact.cost(exact.cheapest()));
      CHECK(fine.least >= exact.cost(exact.cheapest()) / 4);
      CHECK(fine.ranking > fine.least);
      CHECK(fine_cost_of_end(b, half).least == doctest::Approx(4 * dot(b * half, half)));
    }
  }
}

TEST_CASE("ranking takes planes without area, and prefers short edges where planes cost nothing") {
  EdgeCosts costs;
  Quadric plane;
  plane.add({0, 0, 1}, 1);
  const FloatQuadric flat(plane);
  costs.put(0, {}, {}, {1, 0, 0});
  costs.put(1, flat, flat, {1, 0, 0});
  costs.put(2, flat, flat, {0.5, 0, 0});
  costs.compute();
  CHECK(costs.get(0).ranking == 0);
  CHECK(costs.get(1).least == 0);
  CHECK(costs.get(1).ranking > costs.get(2).ranking);
  CHECK(costs.get(2).ranking > 0);
  CHECK(cost_of_end(flat, {0, 0, 1}).least == doctest::Approx(4).epsilon(1e-4));
}
