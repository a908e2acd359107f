// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Encoding of a tree of cells in files of jobs, version 2:
//   which u8 | first grid's bits u32 | parts u32 | weld u8 | most cells u64 | first new grid u32 |
//   limit u64 | leaves u64 | heavy u64 | scans u32 | coarsened u32 | grids u32 x (corner 3 x f64 |
//   cells a unit f64 | steps a unit f64 | bits u32) | cells u64 x (key u64 | vertices u64 | steps 3
//   x u64 | mean 3 x f64 | box 6 x f64 | grid u32 | is one u8), or, of places, cells u64 x (key u64
//   | grid u32 | is one u8)
// Version 1 had no places.
#include <algorithm>
#include <utility>

#include "divide/cell_tree.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_cell_bytes = 117;
constexpr std::uint64_t k_place_bytes = 13;

void put_cell(ByteWriter& out, const Cell& cell, CellTree::Which which) {
  out.put(cell.key);
  if (which != CellTree::Which::places) {
    out.put(cell.vertices);
    out.put(cell.steps);
    out.put(cell.mean);
    out.put(cell.box.lo);
    out.put(cell.box.hi);
  }
  out.put(cell.grid);
  out.put(static_cast<std::uint8_t>(cell.is_one ? 1 : 0));
}

Cell get_cell(ByteReader& in) {
  Cell cell;
  cell.key = in.get<std::uint64_t>();
  cell.vertices = in.get<std::uint64_t>();
  cell.steps = in.get<std::array<std::uint64_t, 3>>();
  cell.mean = in.get<Vec3>();
  cell.box.lo = in.get<Vec3>();
  cell.box.hi = in.get<Vec3>();
  cell.grid = in.get<std::uint32_t>();
  cell.is_one = in.get<std::uint8_t>() != 0;
  return cell;
}

/// A grid has a higher number than that of the cell that it divides, so a search ends.
bool is_divided_by_later(std::uint64_t key, std::uint32_t grid) {
  return grid > key >> CellTree::k_index_bits;
}

}  // namespace

void CellTree::put(ByteWriter& out, Which which) const {
  out.put(which);
  out.put(static_cast<std::uint32_t>(options_.bits));
  out.put(options_.parts);
  out.put(static_cast<std::uint8_t>(options_.weld == Weld::exact ? 1 : 0));
  out.put(static_cast<std::uint64_t>(options_.most_cells));
  out.put(first_new_);
  out.put(static_cast<std::uint64_t>(limit_));
  out.put(static_cast<std::uint64_t>(leaves_));
  out.put(heavy_);
  out.put(static_cast<std::uint32_t>(scans_));
  out.put(coarsened_);
  out.put(static_cast<std::uint32_t>(grids_.size()));
  for (const UniformGrid& grid : grids_) grid.put(out);
  const auto is_wanted = [&](const Cell& cell) {
    return which != Which::counted || cell.key >> k_index_bits >= first_new_;
  };
  std::uint64_t wanted = 0;
  for (const Cell& cell : cells_) wanted += is_wanted(cell) ? 1 : 0;
  out.put(wanted);
  for (const Cell& cell : cells_) {
    if (is_wanted(cell)) put_cell(out, cell, which);
  }
}

/// Everything between `which` and the cells.
CellTree CellTree::get_head(ByteReader& in) {
  CellTreeOptions options;
  options.bits = in.get<std::uint32_t>();
  options.parts = in.get<std::uint32_t>();
  options.weld = in.get<std::uint8_t>() != 0 ? Weld::exact : Weld::off;
  options.most_cells = in.get<std::uint64_t>();
  CellTree tree(Box{}, options);
  tree.first_new_ = in.get<std::uint32_t>();
  tree.limit_ = in.get<std::uint64_t>();
  tree.leaves_ = in.get<std::uint64_t>();
  tree.heavy_ = in.get<std::uint64_t>();
  tree.scans_ = in.get<std::uint32_t>();
  tree.coarsened_ = in.get<std::uint32_t>();
  const auto grids = in.get<std::uint32_t>();
  if (grids == 0) in.fail("cells of no grid");
  tree.grids_.clear();
  for (std::uint32_t i = 0; i < grids; ++i) {
    tree.grids_.push_back(UniformGrid::get(in));
    if (3 * tree.grids_.back().bits() > k_index_bits) in.fail("a grid that is too fine");
  }
  return tree;
}

CellTree CellTree::get(ByteReader& in) {
  const auto which = in.get<Which>();
  if (which != Which::counted && which != Which::all) in.fail("no cells that are counted");
  CellTree tree = get_head(in);
  const bool may_go_on = tree.leaves_ == 0 && tree.first_new_ < tree.grids_.size() &&
                         tree.coarsened_ <= k_index_bits / 3 &&
                         (tree.scans_ == 0 || tree.heavy_ > 0);
  const auto cells = in.get<std::uint64_t>();
  if (!may_go_on || cells > in.remaining() / k_cell_bytes) in.fail("impossible cells");
  tree.cells_.reserve(cells);
  for (std::uint64_t i = 0; i < cells; ++i) {
    tree.cells_.push_back(get_cell(in));
    const Cell& cell = tree.cells_.back();
    if (std::max<std::uint64_t>(cell.grid, cell.key >> k_index_bits) >= tree.grids_.size()) {
      in.fail("a cell of no grid");
    }
    if (cell.grid != 0 && !is_divided_by_later(cell.key, cell.grid)) {
      in.fail("a cell that is divided by an earlier grid");
    }
  }
  std::size_t slots = tree.slots_.size();
  while (cells * 2 + 2 > slots) slots *= 2;
  tree.hash_all(slots);
  return tree;
}

CellTree::Places CellTree::get_places(ByteReader& in) {
  if (in.get<Which>() != Which::places) in.fail("no places of cells");
  CellTree head = get_head(in);
  const auto cells = in.get<std::uint64_t>();
  if (cells > in.remaining() / k_place_bytes || head.leaves_ > cells) in.fail("impossible cells");
  Places places{std::move(head.grids_), {}, {}, {}};
  places.keys.reserve(cells);
  places.is_one.reserve(head.leaves_);
  for (std::uint64_t i = 0; i < cells; ++i) {
    const auto key = in.get<std::uint64_t>();
    const auto grid = in.get<std::uint32_t>();
    const bool is_one = in.get<std::uint8_t>() != 0;
    if (std::max<std::uint64_t>(grid, key >> k_index_bits) >= places.grids.size()) {
      in.fail("a cell of no grid");
    }
    if (i > 0 && i != head.leaves_ && key <= places.keys.back()) in.fail("cells out of order");
    places.keys.push_back(key);
    if (i < head.leaves_) {
      if (grid != 0) in.fail("a divided cell among those that are not");
      places.is_one.push_back(is_one);
    } else {
      if (!is_divided_by_later(key, grid)) in.fail("a cell that is divided by an earlier grid");
      places.divided_by.push_back(grid);
    }
  }
  return places;
}

}  // namespace meshfarm
