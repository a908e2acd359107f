// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "divide/cell_tree.hpp"
#include "divide/share_map.hpp"

namespace meshfarm {

struct CellMapOptions {
  std::uint32_t parts = 1;
  Weld weld = Weld::exact;
  unsigned threads = 0;  // 0: one per core. The parts do not depend on it.
};

/// Compact parts: cells that follow the density of the vertices, grouped by partitioning their
/// graph.
class CellMap : public ShareMap {
 public:
  CellMap(const Box& box, const CellMapOptions& options);
  /// The current state, for another process: while vertices are counted, for decode(); once the
  /// cells are divided, the places, for CellPlaces.
  std::string encode(CellTree::Which which) const;
  /// Throws DataError for anything but the encoding of cells being counted.
  static CellMap decode(std::string_view bytes, unsigned threads = 1);
  /// Adds the counts of a copy.
  void join(CellMap other) { cells_.join(std::move(other.cells_)); }
  std::string_view name() const override { return "cells"; }
  void count(std::span<const Vec3> batch) override;
  bool refine() override { return cells_.refine(); }
  std::uint32_t divide() override;
  bool merges() const override { return merges_; }
  void find_targets(std::span<const Vec3> batch, ShareTargets& targets) override;

 private:
  CellMap(const CellMapOptions& options, CellTree cells)
      : options_(options), cells_(std::move(cells)) {}

  CellMapOptions options_;
  CellTree cells_;
  std::vector<std::uint32_t> part_of_cell_;
  bool merges_ = false;
};

}  // namespace meshfarm
