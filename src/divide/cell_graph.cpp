// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/cell_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

#include <metis.h>

#include <meshfarm/util/errors.hpp>

#include "divide/cell_neighbours.hpp"
#include "divide/weighted_graph.hpp"

namespace {

/// The numbers that rand() would give if no other thread called it: glibc's own, separately per
/// thread.
class OwnRandom {
 public:
  OwnRandom() { ::initstate_r(1, state_, sizeof state_, &data_); }
  void seed(unsigned number) { ::srandom_r(number, &data_); }
  int next() {
    std::int32_t number = 0;
    ::random_r(&data_, &number);
    return number;
  }

 private:
  char state_[128] = {};  // the size that rand() uses
  random_data data_ = {};
};

thread_local OwnRandom own_random;

}  // namespace

// METIS draws from rand(), which belongs to the whole process. So does ZeroMQ's thread that
// reconnects to a lost ventilator or sink: a partition made meanwhile would differ. These functions
// take precedence over those of the C library, also for shared libraries.
extern "C" __attribute__((visibility("default"))) int rand() noexcept {
  return own_random.next();
}

// The name in the C library is a reserved one.
// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name)
extern "C" __attribute__((visibility("default"))) void srand(unsigned number) noexcept {
  own_random.seed(number);
}

namespace meshfarm {
namespace {

/// The place of a cell in its grid.
std::uint64_t place_of(const Cell& cell, std::span<const unsigned> grid_bits) {
  const std::uint64_t grid = cell.key >> CellTree::k_index_bits;
  if (grid >= grid_bits.size()) return cell.key;
  const auto [x, y, z] = CellTree::places_of(cell.key, grid_bits[grid]);
  return grid << CellTree::k_index_bits | z << 24 | y << 12 | x;
}

/// METIS sums up all weights in 32 bits: large ones are scaled down together.
std::vector<std::int32_t> scaled_weights(std::span<const Cell> cells) {
  std::uint64_t total = 0;
  for (const Cell& cell : cells) total += cell.vertices;
  unsigned shift = 0;
  while ((total >> shift) > (std::uint64_t{1} << 29)) ++shift;
  std::vector<std::int32_t> weights;
  weights.reserve(cells.size());
  for (const Cell& cell : cells) {
    weights.push_back(
        static_cast<std::int32_t>(std::max<std::uint64_t>(1, cell.vertices >> shift)));
  }
  return weights;
}

/// Joins each cell to its neighbours, in both directions, each pair once.
WeightedGraph graph_of(std::span<const Cell> cells, const CellGraphOptions& options) {
  const std::size_t k = std::min<std::size_t>(options.neighbours, cells.size());
  const std::vector<std::uint32_t> neighbours =
      cell_neighbours(cells, options.grid_bits, k, options.threads);
  const auto of = [&](std::size_t cell) { return std::span(neighbours).subspan(cell * k, k); };
  // Mutual neighbours are joined by the first of both.
  std::vector<std::uint8_t> joins(neighbours.size(), 0);
  const auto for_pairs = [&](const auto& take) {
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      if (joins[i] != 0) take(i / k, static_cast<std::size_t>(neighbours[i]));
    }
  };
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const auto from = static_cast<std::uint32_t>(i / k);
    const std::uint32_t to = neighbours[i];
    if (to == k_no_cell) continue;
    const auto back = of(to);
    joins[i] = to > from || std::find(back.begin(), back.end(), from) == back.end() ? 1 : 0;
  }
  WeightedGraph graph;
  graph.first.assign(cells.size() + 1, 0);
  for_pairs([&](std::size_t a, std::size_t b) { ++graph.first[a + 1], ++graph.first[b + 1]; });
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  graph.targets.resize(graph.first.back());
  graph.edge_weights.assign(graph.targets.size(), 1);
  std::vector<std::int32_t> at(graph.first.begin(), graph.first.end() - 1);
  for_pairs([&](std::size_t a, std::size_t b) {
    graph.targets[at[a]++] = static_cast<std::int32_t>(b);
    graph.targets[at[b]++] = static_cast<std::int32_t>(a);
  });
  graph.weights = scaled_weights(cells);
  for (const Cell& cell : cells) graph.places.push_back(place_of(cell, options.grid_bits));
  return graph;
}

enum class Metis : std::uint8_t { recursive, k_way };

/// METIS numbers the parts along a recursive bisection, even in its k-way scheme, which starts with
/// one.
std::vector<std::int32_t> run_metis(WeightedGraph& graph, idx_t parts, Metis scheme) {
  static_assert(std::is_same_v<idx_t, std::int32_t>);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  auto nodes = static_cast<idx_t>(graph.nodes());
  idx_t constraints = 1;
  idx_t edge_cut = 0;
  std::vector<std::int32_t> part(graph.nodes(), 0);
  const auto metis = scheme == Metis::recursive ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int status = metis(&nodes, &constraints, graph.first.data(), graph.targets.data(),
                           graph.weights.data(), nullptr, graph.edge_weights.data(), &parts,
                           nullptr, nullptr, options, &edge_cut, part.data());
  if (status != METIS_OK) {
    throw Error("METIS could not divide a graph of " + std::to_string(nodes) + " nodes (status " +
                std::to_string(status) + ")");
  }
  return part;
}

/// METIS divides a coarser graph, and the borders of its parts are refined on each finer one. Its
/// own k-way scheme does the same, but divides the coarsest graph four times, which takes most of
/// its time; the parts have about the same boundary (-4 to +5 % at 96 parts).
std::vector<std::int32_t> divide_multilevel(WeightedGraph cells, std::int32_t parts) {
  constexpr std::size_t k_of_part = 60;       // nodes of the coarsest graph...
  constexpr std::size_t k_of_many = 30;       // ...if these are more than the next
  constexpr std::size_t k_coarsest = 14'400;  // METIS divides this many in 20 ms
  constexpr std::int64_t k_of_heaviest = 12;  // a part has at least this many nodes
  const std::int64_t all =
      std::accumulate(cells.weights.begin(), cells.weights.end(), std::int64_t{0});
  const RefineOptions refine{.parts = parts, .heaviest = all * 103 / (std::int64_t{100} * parts)};

  const auto many = static_cast<std::size_t>(parts);
  const std::size_t coarsest = std::max(k_of_many * many, std::min(k_of_part * many, k_coarsest));

  std::vector<Coarsening> levels;  // each with the graph that the next one is made from
  levels.push_back({std::move(cells), {}});
  while (levels.back().graph.nodes() > coarsest) {
    Coarsening next = coarsened(levels.back().graph, all / (k_of_heaviest * parts));
    if (10 * next.graph.nodes() > 9 * levels.back().graph.nodes()) break;
    levels.push_back(std::move(next));
  }
  std::vector<std::int32_t> part = run_metis(levels.back().graph, parts, Metis::recursive);
  while (true) {
    refine_parts(levels.back().graph, part, refine);
    if (levels.size() == 1) return part;
    std::vector<std::int32_t> finer;
    finer.reserve(levels.back().node_of.size());
    for (const std::int32_t node : levels.back().node_of) finer.push_back(part[node]);
    part = std::move(finer);
    levels.pop_back();
  }
}

/// Few parts are better balanced by recursive bisection; the more parts, the more time a coarser
/// graph saves.
std::vector<std::int32_t> divided(WeightedGraph cells, std::int32_t parts) {
  if (parts <= 8) return run_metis(cells, parts, Metis::recursive);
  if (parts <= 32) return run_metis(cells, parts, Metis::k_way);
  return divide_multilevel(std::move(cells), parts);
}

/// Divides cells along their longest side, by weight, until each piece is a part.
class Bisection {
 public:
  Bisection(std::span<const Cell> cells, std::int32_t parts)
      : cells_(cells), part_(cells.size(), 0) {
    std::vector<std::uint32_t> all(cells.size());
    std::iota(all.begin(), all.end(), 0U);
    divide(all, parts);
  }
  std::vector<std::int32_t> take() { return std::move(part_); }

 private:
  /// `some` has at least as many cells as parts are to be made of it.
  void divide(std::span<std::uint32_t> some, std::int32_t parts) {
    if (parts == 1) {
      for (const std::uint32_t cell : some) part_[cell] = next_;
      ++next_;
      return;
    }
    sort_along_longest(some);
    const std::int32_t left = parts / 2;
    const std::size_t at = std::clamp(split_of(some, static_cast<double>(left) / parts),
                                      static_cast<std::size_t>(left),
                                      some.size() - static_cast<std::size_t>(parts - left));
    divide(some.first(at), left);
    divide(some.subspan(at), parts - left);
  }

  void sort_along_longest(std::span<std::uint32_t> some) const {
    Box box;
    for (const std::uint32_t cell : some) box.add(cells_[cell].mean);
    const Vec3 extent = box.hi - box.lo;
    int axis = 0;
    for (const int other : {1, 2}) axis = extent[other] > extent[axis] ? other : axis;
    std::sort(some.begin(), some.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(cells_[a].mean[axis], a) < std::pair(cells_[b].mean[axis], b);
    });
  }

  /// How many of the cells, from the first on, weigh about `share` of all.
  std::size_t split_of(std::span<const std::uint32_t> some, double share) const {
    double all = 0;
    for (const std::uint32_t cell : some) all += static_cast<double>(cells_[cell].vertices);
    double sum = 0;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto weight = static_cast<double>(cells_[some[i]].vertices);
      if (sum + 0.5 * weight > share * all) return i;
      sum += weight;
    }
    return some.size();
  }

  std::span<const Cell> cells_;
  std::vector<std::int32_t> part_;
  std::int32_t next_ = 0;
};

/// The greatest weight of a part.
std::uint64_t heaviest(std::span<const Cell> cells, const std::vector<std::int32_t>& part,
                       std::int32_t parts) {
  std::vector<std::uint64_t> weights(static_cast<std::size_t>(parts), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) weights[part[i]] += cells[i].vertices;
  return *std::max_element(weights.begin(), weights.end());
}

/// METIS aims at even parts but does not guarantee them.
std::vector<std::int32_t> balanced(std::vector<std::int32_t> part, std::span<const Cell> cells,
                                   std::int32_t parts) {
  constexpr double k_most = 1.1;  // times the mean
  std::uint64_t all = 0;
  for (const Cell& cell : cells) all += cell.vertices;
  const std::uint64_t found = heaviest(cells, part, parts);
  if (static_cast<double>(found) * parts <= k_most * static_cast<double>(all)) return part;
  std::vector<std::int32_t> other = Bisection(cells, parts).take();
  return heaviest(cells, other, parts) < found ? other : part;
}

/// Renumbers the parts without gaps, in the same order.
std::vector<std::uint32_t> without_gaps(const std::vector<std::int32_t>& part, std::int32_t parts) {
  std::vector<std::uint32_t> number(static_cast<std::size_t>(parts), 0);
  for (const std::int32_t p : part) number[p] = 1;
  std::exclusive_scan(number.begin(), number.end(), number.begin(), 0U);
  std::vector<std::uint32_t> result;
  result.reserve(part.size());
  for (const std::int32_t p : part) result.push_back(number[p]);
  return result;
}

}  // namespace

std::string partitioner_name() {
  return "METIS " + std::to_string(METIS_VER_MAJOR) + "." + std::to_string(METIS_VER_MINOR) + "." +
         std::to_string(METIS_VER_SUBMINOR);
}

std::vector<std::uint32_t> partition_cells(std::span<const Cell> cells,
                                           const CellGraphOptions& options) {
  if (options.parts <= 1 || cells.size() <= 1) return std::vector<std::uint32_t>(cells.size(), 0);
  const auto parts = static_cast<std::int32_t>(std::min<std::size_t>(options.parts, cells.size()));
  return without_gaps(balanced(divided(graph_of(cells, options), parts), cells, parts), parts);
}

}  // namespace meshfarm
