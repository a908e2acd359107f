// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

namespace meshfarm {

/// Keeps freed memory in the process for later allocations: fresh pages are expensive (measured:
/// half of the CPU time of a cut). The first 256 MB of the heap use large pages, if the system
/// grants them to programs that ask. Call once, before any threads start. Does nothing without
/// glibc.
void keep_freed_memory();

/// The pool of all processes on a host that no control group limits.
inline constexpr std::uint64_t k_whole_host = 1;

struct MemoryRoom {
  std::uint64_t bytes = 0;
  /// Names the pool of memory on this host. Processes with the same pool share its bytes.
  std::uint64_t pool = k_whole_host;
};

/// The memory that this process may still take: the host's free memory, or less if a control group
/// (version 1 or 2) limits it. Nothing if the system does not say.
std::optional<MemoryRoom> available_memory();
/// Bytes of physical memory that this process uses now; 0 if unknown.
std::uint64_t resident_memory();

}  // namespace meshfarm
