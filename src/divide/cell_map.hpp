// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "divide/cell_tree.hpp"
#include "divide/share_map.hpp"

namespace meshfarm {

struct CellMapOptions {
  std::uint32_t parts = 1;
  Weld weld = Weld::exact;
  unsigned threads = 0;  // 0: one a core. The parts do not depend on it.
};

/// Compact parts: cells that follow the vertices' density, divided by a partition of their graph.
class CellMap : public ShareMap {
 public:
  CellMap(const Box& box, const CellMapOptions& options);
  std::string_view name() const override { return "cells"; }
  void count(std::span<const Vec3> batch) override;
  bool refine() override { return cells_.refine(); }
  std::uint32_t divide() override;
  bool merges() const override { return merges_; }
  void find_targets(std::span<const Vec3> batch, ShareTargets& targets) override;

 private:
  CellMapOptions options_;
  CellTree cells_;
  std::vector<std::uint32_t> part_of_cell_;
  bool merges_ = false;
};

}  // namespace meshfarm
