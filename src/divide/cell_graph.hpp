// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "divide/cell_tree.hpp"

namespace meshfarm {

/// The partitioner and its version, "METIS 5.1.0". Another version may make other parts.
std::string partitioner_name();

struct CellGraphOptions {
  std::uint32_t parts = 1;
  std::uint32_t neighbours = 8;     // of each cell (cell_neighbours.hpp)
  std::vector<unsigned> grid_bits;  // of each grid of the keys; empty: keys are ignored
  unsigned threads = 0;             // 0: one per core. The result does not depend on it.
};

/// Returns the part of each cell. METIS (Karypis & Kumar 1998; Xiong et al. 2008, 3.1 step 2), with
/// a fixed seed, divides a graph of the cells, or a coarser one for more than 32 parts: nodes are
/// weighted by their vertices, edges lead to nearby cells. If a part gets too heavy, the cells are
/// divided by recursive bisection along their longest side instead; then no part exceeds the mean
/// by more than one cell. Parts are numbered from 0 without gaps, along a recursive bisection, so a
/// range of numbers lies together. There may be fewer parts than asked for, never more.
std::vector<std::uint32_t> partition_cells(std::span<const Cell> cells,
                                           const CellGraphOptions& options);

}  // namespace meshfarm
