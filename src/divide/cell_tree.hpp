// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/util/bytes.hpp>

#include "divide/grid.hpp"

namespace meshfarm {

/// A cell that contains vertices.
struct Cell {
  std::uint64_t key = 0;       // its grid, then its index in it; cells are numbered in this order
  std::uint64_t vertices = 0;  // its weight
  Vec3 mean;
  Box box;                 // of its vertices
  std::uint32_t grid = 0;  // the grid that divides it; 0: none
  bool is_one = false;     // a point with so many vertices that they become one immediately
  std::array<std::uint64_t, 3> steps{};  // sum of the steps of its vertices in its grid
};

struct CellTreeOptions {
  unsigned bits = 0;        // of the first grid
  std::uint32_t parts = 1;  // that the cells are for; one part's cells are never divided
  Weld weld = Weld::exact;
  std::size_t most_cells = std::size_t{1} << 20;
};

/// Cells that follow the density of the vertices. The first ones are those of a uniform grid. A
/// cell with more than a 32nd of a part's vertices is replaced by a finer grid over the box of its
/// own vertices, and so on, so that an outlier makes no other cell coarser. If there are too many
/// cells, grids are coarsened: there are at most `most_cells`, plus up to 256 per part if vertices
/// lie in dense spots. Memory: about 110 bytes per cell. The cells depend on the set of vertices,
/// not on its order. If too many vertices lie at one point, they count as one if they will be
/// welded; otherwise they are dealt out, in their order, to cells at that point.
///
/// Add all vertices, and repeat that as long as refine() returns true. For vertices spread evenly
/// over a surface, once is enough. Copies of a tree may each be given some of the vertices, and
/// then be joined: the cells are the same as those of a single tree.
class CellTree {
 public:
  CellTree(const Box& box, const CellTreeOptions& options);
  void add(Vec3 p);
  /// Ends a scan. Returns true if cells were divided: add all vertices again then.
  bool refine();
  /// Adds what a copy of this tree has counted since both were equal.
  void join(CellTree other);

  /// The cells counted since the last refine(); or all; or all, but only what CellPlaces needs of
  /// each.
  enum class Which : std::uint8_t { counted, all, places };
  void put(ByteWriter& out, Which which) const;
  /// Decodes cells that are being counted; throws DataError for anything else. Vertices must not be
  /// dealt out.
  static CellTree get(ByteReader& in);
  struct Places {
    std::vector<UniformGrid> grids;
    /// Ascending: first those of the cells that are not divided, then, ascending again, the others.
    std::vector<std::uint64_t> keys;
    std::vector<bool> is_one;               // of the cells that are not divided
    std::vector<std::uint32_t> divided_by;  // the grid of each of the others
  };
  /// Decodes Which::places; throws DataError for anything else.
  static Places get_places(ByteReader& in);
  /// Whether vertices at one point go to several cells, by their order.
  bool deals() const { return !dealt_.empty(); }

  /// A key is the number of a grid, followed by this many bits for a cell's index in it.
  static constexpr unsigned k_index_bits = 36;
  static constexpr std::uint64_t k_index_mask = (std::uint64_t{1} << k_index_bits) - 1;
  std::vector<unsigned> grid_bits() const;
  /// A cell's places along x, y and z in its grid, which has `bits` bits per axis.
  static std::array<std::uint64_t, 3> places_of(std::uint64_t key, unsigned bits) {
    const std::uint64_t last = (std::uint64_t{1} << bits) - 1;
    return {key & last, key >> bits & last, key >> (2 * bits) & last};
  }

  /// After the last scan.
  std::span<const Cell> cells() const { return std::span(cells_).first(leaves_); }
  /// The number of the cell that contains a vertex that was added. Call it once per vertex, in
  /// order.
  std::uint32_t number_of(Vec3 p);

 private:
  static constexpr std::uint64_t k_no_key = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t key_of(std::uint32_t grid, Vec3 p) const {
    return std::uint64_t{grid} << k_index_bits | grids_[grid].cell_of(p);
  }
  /// A cell that is not divided: its key, and its place in cells_ + 1, or 0 if it has none yet.
  struct Leaf {
    std::uint64_t key = 0;
    std::uint32_t entry = 0;
  };
  Leaf descend(std::uint64_t key, Vec3 p) const;
  std::size_t slot_of(std::uint64_t key) const;
  std::size_t place_of(std::uint64_t key);
  void hash_all(std::size_t slots);
  static CellTree get_head(ByteReader& in);
  void coarsen();
  void divide(Cell& cell);
  void divide_points();
  void finish();

  /// The vertices at a point, dealt out to `cells` cells.
  struct Dealt {
    std::uint64_t vertices = 0;
    std::uint64_t cells = 0;
    std::uint64_t first = 0;  // number of the first of these cells
    std::uint64_t seen = 0;
  };

  CellTreeOptions options_;
  std::vector<UniformGrid> grids_;
  std::uint32_t first_new_ = 0;       // grids from here on are being counted into
  std::vector<std::uint32_t> slots_;  // place in cells_ + 1; 0 is free
  std::vector<Cell> cells_;           // means are set by finish()
  std::size_t limit_;                 // grids are coarsened if there are more cells
  std::size_t leaves_ = 0;            // cells that are not divided; they come first in the end
  std::unordered_map<std::uint64_t, Dealt> dealt_;  // by the key of the cell
  std::uint64_t heavy_ = 0;
  unsigned scans_ = 0;
  std::uint32_t coarsened_ = 0;  // how often in this scan
  std::size_t last_ = 0;         // cell of the last add()
  std::uint64_t last_key_ = k_no_key;
  std::uint32_t last_number_ = 0;
};

}  // namespace meshfarm
