// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

inline constexpr std::uint32_t k_most_slabs = 65'536;

/// How shares of a mesh fit into a memory, each made there as a whole.
struct ShareBudget {
  std::uint64_t memory_bytes = 0;
  std::uint64_t bytes_per_triangle = 0;
  std::uint64_t taken_bytes = 0;  // of the memory, by other things

  /// As many as are wanted, but so many that one fits into half the memory.
  std::uint32_t slabs(std::uint64_t triangles, std::uint64_t wanted) const;
  /// As many at once as fit, going by the average, and not more than asked for; 0: one a core.
  unsigned threads(std::uint64_t triangles, std::uint32_t shares, unsigned asked) const;
};

/// What a part or a stream takes for each triangle while it is made, with finding the facts of its
/// texture.
std::uint64_t bytes_while_made(const MeshSource& source);

}  // namespace meshfarm
