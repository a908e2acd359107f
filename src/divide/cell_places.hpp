// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "divide/cell_tree.hpp"
#include "divide/share_map.hpp"

namespace meshfarm {

/// Finds a key in an ascending list of cell keys. For each grid, a table tells where the keys with
/// the same highest bits of the index begin. It is filled in order; a hash table would have a cache
/// miss per key.
class KeyTable {
 public:
  static constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

  /// `keys`: of cells, ascending; must outlive the table.
  KeyTable(std::span<const std::uint64_t> keys, std::size_t grids);
  /// The position of the key in the list, or k_none.
  std::uint32_t find(std::uint64_t key) const;

 private:
  struct Grid {
    std::size_t first = 0;  // in starts_
    std::size_t rows = 0;
    unsigned shift = 0;  // from an index to its row
  };

  std::span<const std::uint64_t> keys_;
  std::vector<Grid> grids_;
  std::vector<std::uint32_t> starts_;
};

/// The cells of a CellMap after dividing them, from the places in encode(): only what is needed to
/// find the part of a vertex. About 30 bytes per cell, besides the file's 17.
class CellPlaces {
 public:
  /// Throws DataError for anything but places encoded by CellMap::encode().
  static CellPlaces decode(std::string_view bytes);
  CellPlaces(const CellPlaces&) = delete;  // the tables refer to the keys
  CellPlaces& operator=(const CellPlaces&) = delete;
  /// Like CellMap::find_targets(). Throws DataError for a vertex that was not counted.
  void find_targets(std::span<const Vec3> batch, ShareTargets& targets) const;

 private:
  CellPlaces(CellTree::Places places, std::vector<std::uint32_t> part_of_cell);
  std::uint32_t cell_of(std::uint64_t key, Vec3 p) const;

  CellTree::Places places_;
  std::vector<std::uint32_t> part_of_cell_;
  KeyTable leaves_;
  KeyTable divided_;
  bool merges_;
};

}  // namespace meshfarm
