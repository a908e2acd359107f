// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "divide/weighted_graph.hpp"

using namespace meshfarm;

namespace {

/// n x n nodes in a plane, each joined to the four beside it.
WeightedGraph square(std::int32_t n) {
  WeightedGraph graph;
  for (std::int32_t y = 0; y < n; ++y) {
    for (std::int32_t x = 0; x < n; ++x) {
      const auto join = [&](std::int32_t to_x, std::int32_t to_y) {
        if (to_x < 0 || to_y < 0 || to_x >= n || to_y >= n) return;
        graph.targets.push_back(to_y * n + to_x);
        graph.edge_weights.push_back(1);
      };
      join(x - 1, y);
      join(x + 1, y);
      join(x, y - 1);
      join(x, y + 1);
      graph.first.push_back(static_cast<std::int32_t>(graph.targets.size()));
      graph.weights.push_back(1);
      graph.places.push_back(static_cast<std::uint64_t>(y) << 12 | static_cast<std::uint64_t>(x));
    }
  }
  return graph;
}

std::int64_t weight_between(const WeightedGraph& graph, const std::vector<std::int32_t>& part) {
  std::int64_t sum = 0;
  for (std::size_t node = 0; node < graph.nodes(); ++node) {
    for (std::int32_t e = graph.first[node]; e < graph.first[node + 1]; ++e) {
      if (part[graph.targets[e]] != part[node]) sum += graph.edge_weights[e];
    }
  }
  return sum / 2;
}

std::vector<std::int64_t> weights_of(const WeightedGraph& graph,
                                     const std::vector<std::int32_t>& part, std::size_t parts) {
  std::vector<std::int64_t> sums(parts, 0);
  for (std::size_t node = 0; node < graph.nodes(); ++node) sums[part[node]] += graph.weights[node];
  return sums;
}

}  // namespace

TEST_CASE("two rounds of pairs make nodes of 2 x 2, and no edge or weight is lost") {
  const WeightedGraph fine = square(8);
  const Coarsening once = coarsened(fine, 4);
  CHECK(once.graph.nodes() == 32);
  const Coarsening twice = coarsened(once.graph, 4);
  REQUIRE(twice.graph.nodes() == 16);
  for (const std::int32_t weight : twice.graph.weights) CHECK(weight == 4);
  // 2 x 16 edges lie inside the nodes; 2 x 4 x 3 pairs of nodes have two edges each.
  CHECK(twice.graph.targets.size() == 48);
  for (const std::int32_t weight : twice.graph.edge_weights) CHECK(weight == 2);
  const std::set<std::uint64_t> places(twice.graph.places.begin(), twice.graph.places.end());
  CHECK(places.size() == 16);
  CHECK(*places.rbegin() == (std::uint64_t{3} << 12 | 3));
}

TEST_CASE("an edge is as heavy in a coarser graph as in the finer one") {
  WeightedGraph graph = square(30);
  const std::int64_t weight = 900;
  for (int round = 0; round < 5; ++round) {
    Coarsening next = coarsened(graph, 20);
    CAPTURE(round);
    REQUIRE(next.node_of.size() == graph.nodes());
    CHECK(std::accumulate(next.graph.weights.begin(), next.graph.weights.end(), std::int64_t{0}) ==
          weight);
    CHECK(*std::max_element(next.graph.weights.begin(), next.graph.weights.end()) <= 20);
    // The weight between coarse nodes is that between the same groups of fine nodes.
    std::vector<std::int32_t> each(next.graph.nodes());
    std::iota(each.begin(), each.end(), 0);
    CHECK(weight_between(next.graph, each) == weight_between(graph, next.node_of));
    graph = std::move(next.graph);
  }
  CHECK(graph.nodes() < 120);
}

TEST_CASE("nodes that are too heavy for each other stay alone") {
  const WeightedGraph fine = square(3);
  const Coarsening same = coarsened(fine, 1);
  CHECK(same.graph.nodes() == 9);
  CHECK(same.graph.targets == fine.targets);
}

TEST_CASE("a ragged border becomes straight, and no part heavier than it may") {
  const WeightedGraph graph = square(16);
  std::vector<std::int32_t> part;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) part.push_back(x < 8 + (y % 2 == 0 ? 1 : -1) ? 0 : 1);
  }
  const std::int64_t ragged = weight_between(graph, part);
  REQUIRE(ragged == 16 + 15 * 2);
  refine_parts(graph, part, {.parts = 2, .heaviest = 132});
  CHECK(weight_between(graph, part) <= 20);
  for (const std::int64_t weight : weights_of(graph, part, 2)) CHECK(weight <= 132);
  const std::vector<std::int32_t> before = part;
  refine_parts(graph, part, {.parts = 2, .heaviest = 132, .passes = 0});
  CHECK(part == before);
}

TEST_CASE("a part that is too heavy gives nodes away, whatever edges that costs") {
  const WeightedGraph graph = square(12);
  std::vector<std::int32_t> part;
  for (int i = 0; i < 144; ++i) part.push_back(i % 12 < 9 ? 0 : 1);
  refine_parts(graph, part, {.parts = 2, .heaviest = 75, .passes = 30});
  for (const std::int64_t weight : weights_of(graph, part, 2)) CHECK(weight <= 75);
}

TEST_CASE("a graph without nodes or edges is left as it is") {
  CHECK(coarsened({}, 10).graph.nodes() == 0);
  WeightedGraph alone;
  alone.weights = {3, 4};
  alone.places = {0, 1};
  alone.first = {0, 0, 0};
  const Coarsening same = coarsened(alone, 10);
  CHECK(same.node_of == std::vector<std::int32_t>{0, 1});
  std::vector<std::int32_t> part = {1, 0};
  refine_parts(alone, part, {.parts = 2, .heaviest = 1});
  CHECK(part == std::vector<std::int32_t>{1, 0});
}
