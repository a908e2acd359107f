// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "collapse_bench.hpp"
#include "geometry/simplify/simplify_rank.hpp"
#include "geometry/simplify/vertex_flags.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

RankingInput input_of(CollapseBench& bench) {
  return {.positions = bench.mesh.positions,
          .triangles = bench.mesh.triangles,
          .flags = bench.flags,
          .adjacency = &bench.adjacency,
          .creases = &bench.creases};
}

constexpr RankLimits k_all{k_any_cost, HUGE_VAL};

using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Edges edges_of(const Mesh& mesh) {
  Edges edges;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
  }
  return edges;
}

std::vector<RankedEdge> ranked(EdgeRanking& ranking, std::uint32_t vertices,
                               const RankLimits& limits = k_all) {
  const auto found = ranking.cheapest(0, vertices, limits);
  return {found.begin(), found.end()};
}

Edges pairs_of(const std::vector<RankedEdge>& edges) {
  Edges pairs;
  for (const RankedEdge& e : edges) pairs.insert({e.a, e.b});
  return pairs;
}

}  // namespace

TEST_CASE("keys are in the order of the costs, and lose a millionth") {
  const double costs[] = {0, 1e-300, 1e-20, 1e-19, 0.5, 0.5000011, 1, 2, 1e9, 1e300};
  for (std::size_t i = 0; i + 1 < std::size(costs); ++i) {
    CHECK(key_of(costs[i]) < key_of(costs[i + 1]));
  }
  for (const double cost : costs) {
    CHECK(cost_of(key_of(cost)) >= cost);
    if (cost > 0) CHECK(cost_of(key_of(cost)) <= cost * 1.000002);
  }
  CHECK(cost_of(k_any_cost) == HUGE_VAL);
  CHECK(key_of(HUGE_VAL) > key_of(1e308));
}

TEST_CASE("every edge of a closed mesh is ranked once, the cheapest first") {
  CollapseBench bench(sphere(3));
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const auto vertices = static_cast<std::uint32_t>(bench.mesh.positions.size());
  const std::vector<RankedEdge> found = ranked(ranking, vertices);
  CHECK(found.size() == bench.mesh.triangles.size() * 3 / 2);
  CHECK(pairs_of(found) == edges_of(bench.mesh));
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].a < found[i].b);
    // In steps of 3 %.
    if (i > 0) CHECK(cost_of(found[i].key) >= cost_of(found[i - 1].key) * 0.95);
  }
}

TEST_CASE("ranges of vertices share out the edges") {
  CollapseBench bench(wavy_grid(20, 20));
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const auto vertices = static_cast<std::uint32_t>(bench.mesh.positions.size());
  const Edges all = pairs_of(ranked(ranking, vertices));
  Edges shared;
  std::size_t sum = 0;
  for (std::uint32_t first = 0; first < vertices; first += 100) {
    for (const RankedEdge& e : ranking.cheapest(first, std::min(first + 100, vertices), k_all)) {
      CHECK(e.a >= first);
      CHECK(e.a < first + 100);
      shared.insert({e.a, e.b});
      ++sum;
    }
  }
  CHECK(shared == all);
  CHECK(sum == all.size());
}

TEST_CASE("limits leave out what ranks or costs more") {
  CollapseBench bench(wavy_grid(20, 20));
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const auto vertices = static_cast<std::uint32_t>(bench.mesh.positions.size());
  const std::vector<RankedEdge> all = ranked(ranking, vertices);
  const CostKey middle = all[all.size() / 2].key;
  const auto below =
      std::count_if(all.begin(), all.end(), [&](const RankedEdge& e) { return e.key <= middle; });
  const std::vector<RankedEdge> cheap = ranked(ranking, vertices, {middle, HUGE_VAL});
  CHECK(cheap.size() == static_cast<std::size_t>(below));
  CHECK(cheap.size() < all.size());
  CHECK(ranked(ranking, vertices, {k_any_cost, -1}).empty());
}

TEST_CASE("a limit that is estimated lets its share pass") {
  CollapseBench bench(wavy_grid(200, 200));
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const auto vertices = static_cast<std::uint32_t>(bench.mesh.positions.size());
  const auto all = static_cast<double>(ranked(ranking, vertices).size());
  CostKey before = 0;
  for (const double share : {0.05, 0.2, 0.5, 0.9}) {
    const CostKey limit = ranking.estimate_limit(share, HUGE_VAL);
    CHECK(limit > before);
    before = limit;
    const auto found = static_cast<double>(ranked(ranking, vertices, {limit, HUGE_VAL}).size());
    CHECK(found / all == doctest::Approx(share).epsilon(0.1));
  }
  const CostKey few = ranking.estimate_limit(0.5, 1000);
  const auto found = static_cast<double>(ranked(ranking, vertices, {few, HUGE_VAL}).size());
  CHECK(found == doctest::Approx(1000).epsilon(0.35));
}

TEST_CASE("flat edges come before folds, and short ones before long ones") {
  // Flat except for a step along x = 0.5; the columns left of it are half as wide.
  Mesh mesh = grid(20, 20, [](double x, double) { return x > 0.5 ? 0.3 : 0.0; });
  for (Vec3& p : mesh.positions) p.x = p.x < 0.5 ? p.x / 2 : p.x;
  CollapseBench bench(mesh);
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  const std::vector<RankedEdge> found = ranked(ranking, vertices);
  const auto x_of = [&](std::uint32_t v) { return mesh.positions[v].x; };
  const auto is_inside = [&](const RankedEdge& e) { return (bench.flags[e.a] & k_border) == 0; };
  const auto first = std::find_if(found.begin(), found.end(), is_inside);
  REQUIRE(first != found.end());
  CHECK(x_of(first->a) < 0.25);
  const RankedEdge& last = found.back();
  CHECK(std::min(x_of(last.a), x_of(last.b)) > 0.2);
  CHECK(std::max(x_of(last.a), x_of(last.b)) < 0.6);
  CHECK(cost_of(last.key) > 1000 * cost_of(first->key));
}

TEST_CASE("once it is refined, what is flat but for noise is told apart") {
  // Noise of 2e-4 of an edge length on the right, and a tenth of that on the left.
  Random random(5);
  Mesh mesh = flat_grid(40, 40);
  for (Vec3& p : mesh.positions) p.z = (p.x > 0.5 ? 5e-6 : 5e-7) * random.unit();
  CollapseBench bench(mesh);
  RankingInput input = input_of(bench);
  input.bounds = true;
  EdgeRanking ranking;
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  const auto right_ones_of_first = [&] {
    std::vector<RankedEdge> found = ranked(ranking, vertices);
    std::erase_if(found, [&](const RankedEdge& e) {
      return ((bench.flags[e.a] | bench.flags[e.b]) & k_border) != 0;
    });
    REQUIRE(found.size() > 3'000);
    return std::count_if(found.begin(), found.begin() + 1'000, [&](const RankedEdge& e) {
      return mesh.positions[e.a].x > 0.5 && mesh.positions[e.b].x > 0.5;
    });
  };
  ranking.begin_pass(input);
  CHECK(right_ones_of_first() > 300);
  ranking.refine();
  CHECK(right_ones_of_first() < 20);
  std::vector<RankedEdge> at_one;
  ranking.refresh(820);
  ranking.for_edges_at(820, HUGE_VAL, [&](const RankedEdge& e) { at_one.push_back(e); });
  const std::vector<RankedEdge> all = ranked(ranking, vertices);
  CHECK(!at_one.empty());
  for (const RankedEdge& each : at_one) {
    CHECK(std::any_of(all.begin(), all.end(), [&](const RankedEdge& e) {
      return e.a == each.a && e.b == each.b && e.key == each.key;
    }));
  }
  ranking.begin_pass(input);  // is as coarse as before
  CHECK(right_ones_of_first() > 300);
}

TEST_CASE("fixed vertices have no edges, and with a seam only its edges count") {
  CollapseBench bench(wavy_grid(10, 10));
  bench.flags[60] |= k_fixed;
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const auto vertices = static_cast<std::uint32_t>(bench.mesh.positions.size());
  for (const RankedEdge& e : ranked(ranking, vertices)) CHECK((e.a != 60 && e.b != 60));

  bench.flags[71] |= k_seam;
  RankingInput input = input_of(bench);
  input.seam_only = true;
  ranking.begin_pass(input);
  const std::vector<RankedEdge> seam = ranked(ranking, vertices);
  CHECK(!seam.empty());
  for (const RankedEdge& e : seam) CHECK((e.a == 71 || e.b == 71));
}

TEST_CASE("border vertices are ranked along the border and from inside, not across") {
  CollapseBench bench(flat_grid(5, 1));  // all are on the border
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const std::vector<RankedEdge> found =
      ranked(ranking, static_cast<std::uint32_t>(bench.mesh.positions.size()));
  CHECK(!found.empty());
  for (const RankedEdge& e : found) {
    const Vec3& p = bench.mesh.positions[e.a];
    const Vec3& q = bench.mesh.positions[e.b];
    CHECK((p.x == q.x || p.y == q.y));            // no diagonal
    CHECK((p.y == q.y || p.x == 0 || p.x == 1));  // nor across, except at the ends
  }
}

TEST_CASE("a vertex whose star has changed is ranked anew as if all were") {
  CollapseBench bench(wavy_grid(12, 12));
  EdgeRanking ranking;
  ranking.begin_pass(input_of(bench));
  const std::uint32_t moved = 84;
  bench.mesh.positions[moved].z += 0.2;
  std::set<std::uint32_t> changed = {moved};
  for (const Corner& c : bench.adjacency.at(moved)) changed.insert(c.next);
  for (const Corner& c : bench.adjacency.at(moved)) changed.insert(c.prev);
  for (const std::uint32_t v : changed) ranking.refresh(v);
  EdgeRanking anew;
  anew.begin_pass(input_of(bench));
  for (const std::uint32_t v : changed) {
    std::vector<RankedEdge> now;
    std::vector<RankedEdge> then;
    ranking.for_edges_at(v, HUGE_VAL, [&](const RankedEdge& e) { now.push_back(e); });
    anew.for_edges_at(v, HUGE_VAL, [&](const RankedEdge& e) { then.push_back(e); });
    REQUIRE(now.size() == then.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      CHECK(now[i].a == then[i].a);
      CHECK(now[i].b == then[i].b);
      CHECK(cost_of(now[i].key) == doctest::Approx(cost_of(then[i].key)).epsilon(0.001));
    }
  }
}
