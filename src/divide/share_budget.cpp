// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/share_budget.hpp"

#include <algorithm>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/util/control_groups.hpp>

namespace meshfarm {

std::uint32_t ShareBudget::slabs(std::uint64_t triangles, std::uint64_t wanted) const {
  const std::uint64_t half = std::max<std::uint64_t>(1, memory_bytes / 2);
  const std::uint64_t least = triangles * bytes_per_triangle / half + 1;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(k_most_slabs, std::max(wanted, least)));
}

unsigned ShareBudget::threads(std::uint64_t triangles, std::uint32_t shares, unsigned asked) const {
  const std::uint64_t share = bytes_per_triangle * triangles / std::max<std::uint64_t>(1, shares);
  const std::uint64_t left = memory_bytes - std::min(memory_bytes, taken_bytes);
  const std::uint64_t fit = left / std::max<std::uint64_t>(1, share);
  return static_cast<unsigned>(
      std::clamp<std::uint64_t>(fit, 1, asked != 0 ? asked : processors()));
}

std::uint64_t bytes_while_made(const MeshSource& source) {
  constexpr std::uint64_t k_fact_bytes = 40;
  const ColumnSet columns = source.info().columns();
  return slab_bytes_per_triangle(has_appearances(source), columns) +
         (columns.uvs ? k_fact_bytes : 0);
}

}  // namespace meshfarm
