// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/cell_places.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

KeyTable::KeyTable(std::span<const std::uint64_t> keys, std::size_t grids)
    : keys_(keys), grids_(grids) {
  const auto grid_of = [&](std::size_t i) { return keys[i] >> CellTree::k_index_bits; };
  starts_.reserve(2 * keys.size() + grids);  // at most two rows per key, and an end
  std::size_t begin = 0;
  while (begin < keys.size()) {
    std::size_t end = begin + 1;
    while (end < keys.size() && grid_of(end) == grid_of(begin)) ++end;
    Grid& grid = grids_.at(grid_of(begin));
    const std::uint64_t last_index = keys[end - 1] & CellTree::k_index_mask;
    while (last_index >> grid.shift >= 2 * (end - begin)) ++grid.shift;
    grid.first = starts_.size();
    grid.rows = static_cast<std::size_t>(last_index >> grid.shift) + 1;
    std::size_t i = begin;  // where the row begins; an empty row begins at the next key, too
    for (std::size_t row = 0; row <= grid.rows; ++row) {
      while (i < end && (keys[i] & CellTree::k_index_mask) >> grid.shift < row) ++i;
      starts_.push_back(static_cast<std::uint32_t>(i));
    }
    begin = end;
  }
}

std::uint32_t KeyTable::find(std::uint64_t key) const {
  const std::uint64_t number = key >> CellTree::k_index_bits;
  if (number >= grids_.size()) return k_none;
  const Grid& grid = grids_[number];
  const std::uint64_t row_of_grid = (key & CellTree::k_index_mask) >> grid.shift;
  if (row_of_grid >= grid.rows) return k_none;
  const std::size_t row = grid.first + row_of_grid;
  const auto begin = keys_.begin() + starts_[row], end = keys_.begin() + starts_[row + 1];
  const auto found = std::lower_bound(begin, end, key);
  return found != end && *found == key ? static_cast<std::uint32_t>(found - keys_.begin()) : k_none;
}

CellPlaces::CellPlaces(CellTree::Places places, std::vector<std::uint32_t> part_of_cell)
    : places_(std::move(places)),
      part_of_cell_(std::move(part_of_cell)),
      leaves_(std::span(places_.keys).first(places_.is_one.size()), places_.grids.size()),
      divided_(std::span(places_.keys).subspan(places_.is_one.size()), places_.grids.size()),
      merges_(std::find(places_.is_one.begin(), places_.is_one.end(), true) !=
              places_.is_one.end()) {}

CellPlaces CellPlaces::decode(std::string_view bytes) {
  ByteReader in(bytes, "cells of a mesh");
  const std::uint32_t parts = std::max<std::uint32_t>(in.get<std::uint32_t>(), 1);
  CellTree::Places places = CellTree::get_places(in);
  auto part_of_cell = get_list<std::uint32_t>(in);
  in.expect_end();
  if (part_of_cell.size() != places.is_one.size()) in.fail("parts of other cells");
  for (const std::uint32_t part : part_of_cell) {
    if (part >= parts) in.fail("a part that there is not");
  }
  return {std::move(places), std::move(part_of_cell)};
}

std::uint32_t CellPlaces::cell_of(std::uint64_t key, Vec3 p) const {
  while (true) {
    const std::uint32_t cell = leaves_.find(key);
    if (cell != KeyTable::k_none) return cell;
    const std::uint32_t place = divided_.find(key);
    if (place == KeyTable::k_none) {
      throw DataError(
          "a vertex lies where none was counted: has the input changed? Then begin the run again");
    }
    const std::uint64_t grid = places_.divided_by[place];
    key = grid << CellTree::k_index_bits | places_.grids[grid].cell_of(p);
  }
}

void CellPlaces::find_targets(std::span<const Vec3> batch, ShareTargets& targets) const {
  // Neighbours in the file are often neighbours in space.
  std::uint64_t last_key = std::numeric_limits<std::uint64_t>::max();
  std::uint32_t last_cell = 0;
  targets.fill(batch, merges_, [&](Vec3 p) {
    const std::uint64_t key = places_.grids[0].cell_of(p);
    const std::uint32_t cell = key == last_key ? last_cell : cell_of(key, p);
    if (places_.keys[cell] == key) {
      last_key = key;
      last_cell = cell;
    }
    return ShareTargets::One{part_of_cell_[cell],
                             places_.is_one[cell] ? cell : MeshShares::k_no_point};
  });
}

}  // namespace meshfarm
