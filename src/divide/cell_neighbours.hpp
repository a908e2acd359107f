// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "divide/cell_tree.hpp"

namespace meshfarm {

/// Marks a place without a neighbour.
constexpr std::uint32_t k_no_cell = 0xffff'ffff;

/// k neighbours per cell, in k places each: the nearest, by mean, of those that share a face, an
/// edge or a corner with it in its grid. A cell with fewer of these gets the nearest of all cells,
/// so that separate pieces and cells of different sizes are connected. `grid_bits`: of each grid of
/// the keys. Unused places hold k_no_cell. The result does not depend on the threads.
std::vector<std::uint32_t> cell_neighbours(std::span<const Cell> cells,
                                           std::span<const unsigned> grid_bits, std::size_t k,
                                           unsigned threads);

}  // namespace meshfarm
