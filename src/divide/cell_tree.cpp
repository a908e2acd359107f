// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/cell_tree.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <tuple>

namespace meshfarm {
namespace {

constexpr std::size_t k_first_slots = 1024;
constexpr unsigned k_most_bits = 12;
constexpr std::uint64_t k_cells_a_part = 32;      // at least, so that sizes come out even
constexpr std::uint64_t k_cells_of_a_heavy = 16;  // into which a heavy cell of a surface is divided
constexpr unsigned k_most_scans = 32;             // no mesh has numbers that need more
constexpr std::size_t k_no_limit = std::numeric_limits<std::size_t>::max();

/// The finaliser of splitmix64: spreads neighbouring indices over the table.
std::uint64_t spread(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

void add_cell(Cell& cell, const Cell& other) {
  cell.vertices += other.vertices;
  for (std::size_t axis = 0; axis < 3; ++axis) cell.steps[axis] += other.steps[axis];
  cell.box.add(other.box.lo);
  cell.box.add(other.box.hi);
}

bool is_point(const Box& box) {
  return box.lo == box.hi;
}

}  // namespace

CellTree::CellTree(const Box& box, const CellTreeOptions& options)
    : options_(options),
      grids_{UniformGrid(box, std::min(options.bits, k_most_bits))},
      limit_(options.most_cells) {
  static_assert(3 * k_most_bits <= k_index_bits);
  hash_all(k_first_slots);
}

std::size_t CellTree::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = spread(key) & mask;
  while (slots_[slot] != 0 && cells_[slots_[slot] - 1].key != key) slot = (slot + 1) & mask;
  return slot;
}

/// The leaf that contains `p`, which lies in the cell `key`.
CellTree::Leaf CellTree::descend(std::uint64_t key, Vec3 p) const {
  while (true) {
    const std::uint32_t entry = slots_[slot_of(key)];
    if (entry == 0 || cells_[entry - 1].grid == 0) return {key, entry};
    key = key_of(cells_[entry - 1].grid, p);
  }
}

void CellTree::add(Vec3 p) {
  std::uint64_t key = key_of(0, p);
  if (first_new_ > 0) key = descend(key, p).key;
  if (key >> k_index_bits < first_new_) return;  // an earlier scan has counted it
  // Neighbours in the file are often neighbours in space.
  if (last_ >= cells_.size() || cells_[last_].key != key) last_ = place_of(key);
  Cell& cell = cells_[last_];
  ++cell.vertices;
  const std::array<std::uint64_t, 3> steps = grids_[key >> k_index_bits].steps_to(p);
  for (std::size_t axis = 0; axis < 3; ++axis) cell.steps[axis] += steps[axis];
  cell.box.add(p);
  while (cells_.size() > limit_) coarsen();
}

void CellTree::join(CellTree other) {
  while (coarsened_ < other.coarsened_) coarsen();
  while (other.coarsened_ < coarsened_) other.coarsen();
  for (const Cell& cell : other.cells_) {
    if (cell.key >> k_index_bits >= first_new_) add_cell(cells_[place_of(cell.key)], cell);
  }
  while (cells_.size() > limit_) coarsen();
}

std::size_t CellTree::place_of(std::uint64_t key) {
  std::size_t slot = slot_of(key);
  if (slots_[slot] == 0) {
    if ((cells_.size() + 1) * 2 > slots_.size()) {
      hash_all(slots_.size() * 2);
      slot = slot_of(key);
    }
    cells_.push_back({.key = key, .mean = {}, .box = {}});
    slots_[slot] = static_cast<std::uint32_t>(cells_.size());
  }
  return slots_[slot] - 1;
}

void CellTree::hash_all(std::size_t slots) {
  slots_.assign(slots, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    slots_[slot_of(cells_[i].key)] = static_cast<std::uint32_t>(i + 1);
  }
}

/// Coarsens all grids of this scan by the same factor, so that they do not depend on which vertex
/// exceeded the limit of cells.
void CellTree::coarsen() {
  ++coarsened_;
  bool can_again = false;
  std::vector<bool> coarser(grids_.size(), false);
  for (std::uint32_t grid = first_new_; grid < grids_.size(); ++grid) {
    if (grids_[grid].bits() <= 1) continue;
    grids_[grid].coarsen();
    coarser[grid] = true;
    can_again = can_again || grids_[grid].bits() > 1;
  }
  for (Cell& cell : cells_) {
    const auto grid = static_cast<std::uint32_t>(cell.key >> k_index_bits);
    if (!coarser[grid]) continue;
    cell.key = (cell.key & ~k_index_mask) | grids_[grid].coarser_cell(cell.key & k_index_mask);
  }
  std::stable_sort(cells_.begin(), cells_.end(),
                   [](const Cell& a, const Cell& b) { return a.key < b.key; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (kept > 0 && cells_[kept - 1].key == cells_[i].key) {
      add_cell(cells_[kept - 1], cells_[i]);
    } else {
      cells_[kept++] = cells_[i];
    }
  }
  cells_.resize(kept);
  hash_all(slots_.size());
  last_ = 0;
  if (!can_again) limit_ = k_no_limit;
}

bool CellTree::refine() {
  coarsened_ = 0;
  if (scans_++ == 0) {
    std::uint64_t all = 0;
    for (const Cell& cell : cells_) all += cell.vertices;
    heavy_ = std::max<std::uint64_t>(1, all / (k_cells_a_part * std::max(1U, options_.parts)));
    if (options_.parts <= 1) heavy_ = all;
  }
  // By key, so that the numbering of grids does not depend on the order of the vertices.
  std::sort(cells_.begin(), cells_.end(),
            [](const Cell& a, const Cell& b) { return a.key < b.key; });
  const auto grids = static_cast<std::uint32_t>(grids_.size());
  std::size_t divided = 0;
  for (Cell& cell : cells_) {
    const bool is_heavy = cell.grid == 0 && cell.vertices > heavy_ && !is_point(cell.box);
    if (is_heavy && scans_ < k_most_scans) divide(cell);
    divided += cell.grid != 0;
  }
  first_new_ = grids;
  limit_ = std::max(options_.most_cells, cells_.size()) + divided;
  if (grids == grids_.size()) {
    finish();
    return false;
  }
  hash_all(slots_.size());
  return true;
}

void CellTree::divide(Cell& cell) {
  const std::uint64_t wanted = k_cells_of_a_heavy * (cell.vertices / heavy_);
  unsigned bits = 2;
  while (bits < k_most_bits && (std::uint64_t{1} << (2 * bits)) < wanted) ++bits;
  cell.grid = static_cast<std::uint32_t>(grids_.size());
  grids_.emplace_back(cell.box, bits);
}

/// Deals the vertices of a heavy point out to its cell and additional ones. The keys of these are
/// past those of all grids: nobody looks them up, and they are the last of the leaves.
void CellTree::divide_points() {
  std::vector<Cell> more;
  for (Cell& cell : cells_) {
    if (cell.grid != 0 || cell.vertices <= heavy_ || !is_point(cell.box)) continue;
    if (options_.weld == Weld::exact) {
      if (cell.vertices < k_crowd) continue;
      cell.is_one = true;
      cell.vertices = 1;
      continue;
    }
    const std::uint64_t vertices = cell.vertices;
    const std::uint64_t cells = (vertices + heavy_ - 1) / heavy_;
    const auto first_of = [&](std::uint64_t i) { return (vertices * i + cells - 1) / cells; };
    dealt_[cell.key] = {vertices, cells, more.size(), 0};
    for (std::uint64_t i = 1; i < cells; ++i) {
      Cell piece = cell;
      piece.key = (grids_.size() + more.size()) << k_index_bits;
      piece.vertices = first_of(i + 1) - first_of(i);
      more.push_back(piece);
    }
    cell.vertices = first_of(1);
  }
  cells_.insert(cells_.end(), more.begin(), more.end());
}

void CellTree::finish() {
  for (Cell& cell : cells_) {
    const UniformGrid& grid = grids_[cell.key >> k_index_bits];
    cell.mean = is_point(cell.box) ? cell.box.lo : grid.mean_of(cell.steps, cell.vertices);
  }
  if (options_.parts > 1) divide_points();
  std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
    return std::tuple(a.grid != 0, a.key) < std::tuple(b.grid != 0, b.key);
  });
  for (const Cell& cell : cells_) leaves_ += cell.grid == 0;
  std::uint64_t dealt_cells = 0;
  for (const auto& [key, dealt] : dealt_) dealt_cells += dealt.cells - 1;
  for (auto& [key, dealt] : dealt_) dealt.first += leaves_ - dealt_cells;
  std::size_t slots = slots_.size();
  while (cells_.size() * 2 > slots) slots *= 2;
  hash_all(slots);
}

std::vector<unsigned> CellTree::grid_bits() const {
  std::vector<unsigned> bits;
  bits.reserve(grids_.size());
  for (const UniformGrid& grid : grids_) bits.push_back(grid.bits());
  return bits;
}

std::uint32_t CellTree::number_of(Vec3 p) {
  const std::uint64_t key = key_of(0, p);
  if (key == last_key_) return last_number_;
  const Leaf leaf = descend(key, p);
  assert(leaf.entry != 0);
  const auto dealt = dealt_.empty() ? dealt_.end() : dealt_.find(leaf.key);
  if (dealt != dealt_.end()) {
    Dealt& point = dealt->second;
    const std::uint64_t piece = point.seen++ * point.cells / point.vertices;
    return piece == 0 ? leaf.entry - 1 : static_cast<std::uint32_t>(point.first + piece - 1);
  }
  if (leaf.key == key) {
    last_key_ = key;
    last_number_ = leaf.entry - 1;
  }
  return leaf.entry - 1;
}

}  // namespace meshfarm
