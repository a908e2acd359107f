// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

namespace meshfarm {

/// From now on freed memory stays with the process for the next allocation: parts of a like size
/// follow each other, and fresh pages cost more than what is done with them (measured: half the CPU
/// time of a cut). Called once, before there are threads. Without glibc it does nothing.
void keep_freed_memory();
/// And from now on each thread has memory of its own again: for threads that allocate small things
/// all the time and share none of them, who would wait for each other.
void split_memory_by_threads();

/// The pool of all processes of a host that no control group holds to less.
inline constexpr std::uint64_t k_whole_host = 1;

struct MemoryRoom {
  std::uint64_t bytes = 0;
  /// Names what they are taken from, on this host: processes that tell the same share them.
  std::uint64_t pool = k_whole_host;
};

/// What this process may still take: what the host has free, or less where a control group (version
/// 1 or 2) holds it to less. Nothing where the system does not say.
std::optional<MemoryRoom> available_memory();
/// Bytes of physical memory that this process uses now; 0 where the system does not say.
std::uint64_t resident_memory();

}  // namespace meshfarm
