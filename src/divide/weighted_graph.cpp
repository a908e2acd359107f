// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/weighted_graph.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace meshfarm {
namespace {

using Node = std::int32_t;
constexpr Node k_none = -1;

/// The place in a grid of cells twice as large.
std::uint64_t halved(std::uint64_t place) {
  constexpr std::uint64_t k_index = (std::uint64_t{1} << 36) - 1;
  // Removes the bits that came from the next coordinate.
  constexpr std::uint64_t k_halves = 0x7ff7ff7ff;
  return (place & ~k_index) | (((place & k_index) >> 1) & k_halves);
}

template <class Take>
void for_edges(const WeightedGraph& graph, Node node, const Take& take) {
  for (std::int32_t e = graph.first[node]; e < graph.first[node + 1]; ++e) {
    take(graph.targets[e], graph.edge_weights[e]);
  }
}

struct Pair {
  Node one = k_none;
  Node other = k_none;  // k_none if the node is not paired
};

class Matching {
 public:
  Matching(const WeightedGraph& fine, std::int64_t heaviest) : fine_(fine), heaviest_(heaviest) {
    for (const std::uint64_t place : fine.places) blocks_.push_back(halved(place));
  }

  Coarsening take() {
    Coarsening made;
    made.node_of.assign(fine_.nodes(), k_none);
    for (Node node = 0; node < static_cast<Node>(fine_.nodes()); ++node) {
      if (made.node_of[node] != k_none) continue;
      const Pair pair{node, partner_of(node, made.node_of)};
      made.node_of[node] = static_cast<Node>(pairs_.size());
      if (pair.other != k_none) made.node_of[pair.other] = static_cast<Node>(pairs_.size());
      pairs_.push_back(pair);
    }
    put_nodes(made.graph);
    put_edges(made.node_of, made.graph);
    return made;
  }

 private:
  Node partner_of(Node node, const std::vector<Node>& node_of) const {
    Node best = k_none;
    std::tuple<std::int32_t, bool, std::int32_t> best_rank;
    for_edges(fine_, node, [&](Node other, std::int32_t weight) {
      if (node_of[other] != k_none || other == node) return;
      if (std::int64_t{fine_.weights[node]} + fine_.weights[other] > heaviest_) return;
      const std::tuple rank(weight, blocks_[other] == blocks_[node], -fine_.weights[other]);
      if (best != k_none && rank <= best_rank) return;
      best = other;
      best_rank = rank;
    });
    return best;
  }

  void put_nodes(WeightedGraph& graph) const {
    // A surface fills about four of eight cells, which become one node in two rounds.
    const std::vector<std::uint64_t>& places = fine_.rounds % 2 == 1 ? blocks_ : fine_.places;
    for (const Pair& pair : pairs_) {
      const std::int32_t more = pair.other == k_none ? 0 : fine_.weights[pair.other];
      graph.weights.push_back(fine_.weights[pair.one] + more);
      graph.places.push_back(places[pair.one]);
    }
    graph.rounds = fine_.rounds + 1;
  }

  void put_edges(const std::vector<Node>& node_of, WeightedGraph& graph) const {
    graph.targets.reserve(fine_.targets.size());
    graph.edge_weights.reserve(fine_.targets.size());
    std::vector<std::int32_t> place_of(pairs_.size(),
                                       -1);  // of the edge to a node, among all edges
    for (Node node = 0; node < static_cast<Node>(pairs_.size()); ++node) {
      const auto begin = static_cast<std::int32_t>(graph.targets.size());
      const auto add = [&](Node fine_target, std::int32_t weight) {
        const Node target = node_of[fine_target];
        if (target == node) return;
        if (place_of[target] >= begin) {
          graph.edge_weights[place_of[target]] += weight;
          return;
        }
        place_of[target] = static_cast<std::int32_t>(graph.targets.size());
        graph.targets.push_back(target);
        graph.edge_weights.push_back(weight);
      };
      for_edges(fine_, pairs_[node].one, add);
      if (pairs_[node].other != k_none) for_edges(fine_, pairs_[node].other, add);
      graph.first.push_back(static_cast<std::int32_t>(graph.targets.size()));
    }
  }

  const WeightedGraph& fine_;
  std::int64_t heaviest_;
  std::vector<std::uint64_t> blocks_;  // places of the nodes among 2 x 2 x 2 cells
  std::vector<Pair> pairs_;
};

class Refinement {
 public:
  Refinement(const WeightedGraph& graph, std::span<std::int32_t> part, const RefineOptions& options)
      : graph_(graph),
        part_(part),
        options_(options),
        weights_(options.parts, 0),
        ties_(options.parts, 0),
        waits_(graph.nodes(), 0) {
    for (std::size_t node = 0; node < graph.nodes(); ++node) {
      weights_[part[node]] += graph.weights[node];
    }
  }

  void run() {
    for (Node node = 0; node < static_cast<Node>(graph_.nodes()); ++node) {
      if (is_at_border(node)) wait(node);
    }
    for (int pass = 0; pass < options_.passes && !waiting_.empty(); ++pass) {
      std::vector<Node> now = std::exchange(waiting_, {});
      std::sort(now.begin(), now.end());
      for (const Node node : now) {
        waits_[node] = 0;
        if (const auto to = best_part_of(node); to != part_[node]) move(node, to);
      }
    }
  }

 private:
  bool is_at_border(Node node) const {
    bool found = false;
    for_edges(graph_, node, [&](Node other, std::int32_t /*weight*/) {
      found = found || part_[other] != part_[node];
    });
    return found;
  }

  void wait(Node node) {
    if (std::exchange(waits_[node], std::uint8_t{1}) == 0) waiting_.push_back(node);
  }

  std::int32_t best_part_of(Node node) {
    const std::int32_t from = part_[node];
    beside_.clear();
    for_edges(graph_, node, [&](Node other, std::int32_t weight) {
      const std::int32_t part = part_[other];
      if (ties_[part] == 0) beside_.push_back(part);
      ties_[part] += weight;
    });
    const bool is_heavy = weights_[from] > options_.heaviest;
    std::int32_t best = from;
    std::int64_t best_gain = is_heavy ? std::numeric_limits<std::int64_t>::min() : 0;
    std::int64_t best_weight = weights_[from];  // of the part that the node would be in
    for (const std::int32_t part : beside_) {
      const std::int64_t weight = weights_[part] + graph_.weights[node];
      const bool may_grow = weight <= options_.heaviest || (is_heavy && weight < weights_[from]);
      if (part == from || !may_grow) continue;
      const std::int64_t gain = ties_[part] - ties_[from];
      if (gain < best_gain || (gain == best_gain && weight >= best_weight)) continue;
      best = part;
      best_gain = gain;
      best_weight = weight;
    }
    for (const std::int32_t part : beside_) ties_[part] = 0;
    return best;
  }

  void move(Node node, std::int32_t to) {
    weights_[part_[node]] -= graph_.weights[node];
    weights_[to] += graph_.weights[node];
    part_[node] = to;
    wait(node);
    for_edges(graph_, node, [&](Node other, std::int32_t /*weight*/) { wait(other); });
  }

  const WeightedGraph& graph_;
  std::span<std::int32_t> part_;
  const RefineOptions& options_;
  std::vector<std::int64_t> weights_;  // of the parts
  std::vector<std::int64_t> ties_;     // of the current node to each part
  std::vector<std::int32_t> beside_;   // parts that these ties lead to
  std::vector<std::uint8_t> waits_;    // whether a node is queued to be looked at again
  std::vector<Node> waiting_;
};

}  // namespace

Coarsening coarsened(const WeightedGraph& fine, std::int64_t heaviest) {
  return Matching(fine, heaviest).take();
}

void refine_parts(const WeightedGraph& graph, std::span<std::int32_t> part,
                  const RefineOptions& options) {
  Refinement(graph, part, options).run();
}

}  // namespace meshfarm
