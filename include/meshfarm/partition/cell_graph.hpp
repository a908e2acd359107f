// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/partition/cell_tree.hpp>

namespace meshfarm {

/// By what cells are partitioned, "METIS 5.1.0": another version may make other parts.
std::string partitioner_name();

struct CellGraphOptions {
  std::uint32_t parts = 1;
  std::uint32_t neighbours = 8;  // k of the k nearest cells by mean position
  unsigned threads = 0;          // 0: one a core. The result does not depend on it.
};

/// The part of each cell: a graph with a node a cell, weighted by its vertices, and edges to its
/// nearest cells, cut by METIS (Karypis & Kumar 1998; Xiong et al. 2008, 3.1 step 2) with a fixed
/// seed; where that leaves a part too heavy the cells are halved along their longest side again and
/// again instead: then none has more than the mean and a cell more. Parts are numbered 0.. without
/// gaps; there may be fewer than asked for, never more.
std::vector<std::uint32_t> partition_cells(std::span<const Cell> cells,
                                           const CellGraphOptions& options);

}  // namespace meshfarm
