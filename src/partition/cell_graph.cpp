// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include <metis.h>
#include <nanoflann.hpp>

#include <meshfarm/partition/cell_graph.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// The view of the cells' mean positions that nanoflann asks for.
struct CellCloud {
  std::span<const Cell> cells;
  std::size_t kdtree_get_point_count() const { return cells.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return cells[i].mean[static_cast<int>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};

using Edge = std::pair<idx_t, idx_t>;

/// Both directions of every edge from a cell to one of its nearest, sorted.
std::vector<Edge> nearest_edges(std::span<const Cell> cells, std::uint32_t neighbours) {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CellCloud>,
                                                   CellCloud, 3, std::uint32_t>;
  const CellCloud cloud{cells};
  const Tree tree(3, cloud);
  const std::size_t wanted = std::min<std::size_t>(neighbours + 1, cells.size());
  std::vector<std::uint32_t> found(wanted);
  std::vector<double> distances(wanted);
  std::vector<Edge> edges;
  edges.reserve(cells.size() * neighbours * 2);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double point[3] = {cells[i].mean.x, cells[i].mean.y, cells[i].mean.z};
    const std::size_t count = tree.knnSearch(point, wanted, found.data(), distances.data());
    for (std::size_t k = 0; k < count; ++k) {
      if (found[k] == i) continue;
      edges.emplace_back(static_cast<idx_t>(i), static_cast<idx_t>(found[k]));
      edges.emplace_back(static_cast<idx_t>(found[k]), static_cast<idx_t>(i));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// METIS adds all weights up in 32 bits: large ones are scaled down together.
std::vector<idx_t> scaled_weights(std::span<const Cell> cells) {
  std::uint64_t total = 0;
  for (const Cell& cell : cells) total += cell.vertices;
  unsigned shift = 0;
  while ((total >> shift) > (std::uint64_t{1} << 29)) ++shift;
  std::vector<idx_t> weights;
  weights.reserve(cells.size());
  for (const Cell& cell : cells) {
    weights.push_back(static_cast<idx_t>(std::max<std::uint64_t>(1, cell.vertices >> shift)));
  }
  return weights;
}

std::vector<idx_t> run_metis(std::span<const Cell> cells, const std::vector<Edge>& edges,
                             idx_t parts) {
  std::vector<idx_t> first(cells.size() + 1, 0);
  std::vector<idx_t> targets;
  targets.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++first[from + 1];
    targets.push_back(to);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) first[i + 1] += first[i];
  std::vector<idx_t> weights = scaled_weights(cells);

  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  idx_t nodes = static_cast<idx_t>(cells.size());
  idx_t constraints = 1;
  idx_t edge_cut = 0;
  std::vector<idx_t> part(cells.size(), 0);
  // Few parts come out better balanced by recursive bisection; many are cut faster k-way.
  const auto metis = parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int status =
      metis(&nodes, &constraints, first.data(), targets.data(), weights.data(), nullptr, nullptr,
            &parts, nullptr, nullptr, options, &edge_cut, part.data());
  if (status != METIS_OK) {
    throw Error("METIS could not cut the graph of " + std::to_string(cells.size()) +
                " cells (status " + std::to_string(status) + ")");
  }
  return part;
}

/// Numbers the parts in the order in which the cells meet them, without gaps.
std::vector<std::uint32_t> renumbered(const std::vector<idx_t>& part, idx_t parts) {
  constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(static_cast<std::size_t>(parts), k_none);
  std::vector<std::uint32_t> result;
  result.reserve(part.size());
  std::uint32_t next = 0;
  for (const idx_t p : part) {
    if (number[p] == k_none) number[p] = next++;
    result.push_back(number[p]);
  }
  return result;
}

}  // namespace

std::vector<std::uint32_t> partition_cells(std::span<const Cell> cells,
                                           const CellGraphOptions& options) {
  if (options.parts <= 1 || cells.size() <= 1) return std::vector<std::uint32_t>(cells.size(), 0);
  if (cells.size() > (std::size_t{1} << 26)) {
    throw Error("too many grid cells to cut: " + std::to_string(cells.size()));
  }
  const auto parts = static_cast<idx_t>(std::min<std::size_t>(options.parts, cells.size()));
  const std::vector<Edge> edges = nearest_edges(cells, options.neighbours);
  return renumbered(run_metis(cells, edges, parts), parts);
}

}  // namespace meshfarm
