// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/cell_map.hpp"

#include <algorithm>

#include <meshfarm/util/byte_lists.hpp>

#include "divide/cell_graph.hpp"

namespace meshfarm {
namespace {

/// Parts have 200 to 1000 cells each: fine enough for even sizes and smooth seams. If there are
/// many parts, they have about 40 to 160, as one process divides all cells: with these, the Moon in
/// 480 or 1,440 parts has 1 % more boundary than with four times as many cells, which take four
/// times as long.
unsigned grid_bits(std::uint32_t parts) {
  if (parts == 1) return 0;
  constexpr std::uint64_t k_of_few = 512;
  constexpr std::uint64_t k_of_many = 34;
  constexpr std::uint64_t k_few = 32;
  const std::uint64_t wanted =
      std::max(k_of_few * std::min<std::uint64_t>(parts, k_few), k_of_many * std::uint64_t{parts});
  unsigned bits = 4;
  while (bits < 12 && (std::uint64_t{1} << (2 * bits)) < wanted) ++bits;
  return bits;
}

/// The box of a surface has six sides of cells, so smooth surfaces have fewer than k_sides times
/// the cells of a side. What fills space, as foam does, would have a cell for every vertex or two:
/// its grid is coarsened.
CellTreeOptions options_of_tree(const CellMapOptions& options) {
  constexpr std::size_t k_sides = 8;
  CellTreeOptions tree{
      .bits = grid_bits(options.parts), .parts = options.parts, .weld = options.weld};
  tree.most_cells = std::min(tree.most_cells, k_sides << (2 * tree.bits));
  return tree;
}

}  // namespace

CellMap::CellMap(const Box& box, const CellMapOptions& options)
    : options_(options), cells_(box, options_of_tree(options)) {}

void CellMap::count(std::span<const Vec3> batch) {
  for (const Vec3& p : batch) {
    if (has_position(p)) cells_.add(p);
  }
}

std::uint32_t CellMap::divide() {
  const std::span<const Cell> cells = cells_.cells();
  merges_ = std::any_of(cells.begin(), cells.end(), [](const Cell& cell) { return cell.is_one; });
  part_of_cell_ = partition_cells(
      cells,
      {.parts = options_.parts, .grid_bits = cells_.grid_bits(), .threads = options_.threads});
  const auto last = std::max_element(part_of_cell_.begin(), part_of_cell_.end());
  return last == part_of_cell_.end() ? 0 : *last + 1;
}

std::string CellMap::encode(CellTree::Which which) const {
  ByteWriter out;
  out.put(options_.parts);
  cells_.put(out, which);
  put_list(out, part_of_cell_);
  return out.take();
}

CellMap CellMap::decode(std::string_view bytes, unsigned threads) {
  ByteReader in(bytes, "cells of a mesh");
  const auto parts = in.get<std::uint32_t>();
  CellMap map({parts, Weld::exact, threads}, CellTree::get(in));
  if (!get_list<std::uint32_t>(in).empty()) in.fail("parts of cells that are counted");
  in.expect_end();
  return map;
}

void CellMap::find_targets(std::span<const Vec3> batch, ShareTargets& targets) {
  const std::span<const Cell> cells = cells_.cells();
  targets.fill(batch, merges_, [&](Vec3 p) {
    const std::uint32_t cell = cells_.number_of(p);
    return ShareTargets::One{part_of_cell_[cell],
                             cells[cell].is_one ? cell : MeshShares::k_no_point};
  });
}

}  // namespace meshfarm
