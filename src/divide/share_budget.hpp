// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm {

inline constexpr std::uint32_t k_most_slabs = 65'536;

/// How shares of a mesh fit into memory when each is made there as a whole.
struct ShareBudget {
  std::uint64_t memory_bytes = 0;
  std::uint64_t bytes_per_triangle = 0;
  std::uint64_t taken_bytes = 0;  // of the memory, for other things

  /// The number wanted, or more if one would not fit into half the memory.
  std::uint32_t slabs(std::uint64_t triangles, std::uint64_t wanted) const;
  /// How many fit at once, on average, but at most `asked`; 0: one per core.
  unsigned threads(std::uint64_t triangles, std::uint32_t shares, unsigned asked) const;
};

/// The memory for a part or a stream while it is made, per triangle, including that to find the
/// facts of its texture.
std::uint64_t bytes_while_made(const MeshSource& source);

}  // namespace meshfarm
