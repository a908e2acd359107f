// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

inline constexpr std::uint32_t k_most_slabs = 65'536;

/// How slabs fit into a memory, each sorted there as a whole.
struct SlabBudget {
  std::uint64_t memory_bytes = 0;
  std::uint64_t bytes_per_triangle = 0;

  /// As many as are wanted, but so many that one fits into half the memory.
  std::uint32_t slabs(std::uint64_t triangles, std::uint64_t wanted) const;
  /// As many at once as fit, going by the average, and not more than asked for; 0: one a core.
  unsigned threads(std::uint64_t triangles, std::uint32_t slabs, unsigned asked) const;
};

}  // namespace meshfarm
