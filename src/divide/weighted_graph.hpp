// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace meshfarm {

/// An undirected graph whose nodes have places in grids.
struct WeightedGraph {
  /// The edges of node i begin at first[i]; each edge is stored twice, once at each end.
  std::vector<std::int32_t> first = {0};
  std::vector<std::int32_t> targets;
  std::vector<std::int32_t> edge_weights;
  std::vector<std::int32_t> weights;  // of the nodes
  std::vector<std::uint64_t> places;  // of the nodes: grid << 36 | z << 24 | y << 12 | x
  unsigned rounds = 0;  // of pairing: after two, places are those of 2 x 2 x 2 cells, and so on

  std::size_t nodes() const { return weights.size(); }
};

struct Coarsening {
  WeightedGraph graph;
  std::vector<std::int32_t> node_of;  // for each node of the finer graph
};

/// A graph of about half as many nodes: each is either two nodes that were joined by an edge, or
/// one. Each node in turn takes the heaviest edge to an unpaired node (heavy edge matching, Karypis
/// & Kumar 1998); among equal ones, an edge within the same 2 x 2 x 2 cells, so that nodes become
/// compact. No pair is heavier than `heaviest`.
Coarsening coarsened(const WeightedGraph& fine, std::int64_t heaviest);

struct RefineOptions {
  std::int32_t parts = 1;
  std::int64_t heaviest = 0;  // the maximum weight of a part
  int passes = 10;
};

/// Moves nodes at the borders of parts to neighbouring parts, as long as that makes the edges
/// between parts lighter or, at the same weight, parts more even (greedy k-way refinement, Karypis
/// & Kumar 1998). Parts above the limit give away nodes at any price.
void refine_parts(const WeightedGraph& graph, std::span<std::int32_t> part,
                  const RefineOptions& options);

}  // namespace meshfarm
