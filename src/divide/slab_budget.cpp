// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/slab_budget.hpp"

#include <algorithm>

#include <meshfarm/util/control_groups.hpp>

namespace meshfarm {

std::uint32_t SlabBudget::slabs(std::uint64_t triangles, std::uint64_t wanted) const {
  const std::uint64_t half = std::max<std::uint64_t>(1, memory_bytes / 2);
  const std::uint64_t least = triangles * bytes_per_triangle / half + 1;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(k_most_slabs, std::max(wanted, least)));
}

unsigned SlabBudget::threads(std::uint64_t triangles, std::uint32_t slabs, unsigned asked) const {
  const std::uint64_t slab = bytes_per_triangle * triangles / std::max<std::uint64_t>(1, slabs);
  const std::uint64_t fit = memory_bytes / std::max<std::uint64_t>(1, slab);
  return static_cast<unsigned>(
      std::clamp<std::uint64_t>(fit, 1, asked != 0 ? asked : processors()));
}

}  // namespace meshfarm
