// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// From now on freed memory stays with the process for the next allocation: parts of a like size
/// follow each other, and fresh pages cost more than what is done with them (measured: half the CPU
/// time of a cut). Called once, before there are threads. Without glibc it does nothing.
void keep_freed_memory();
/// And from now on each thread has memory of its own again: for threads that allocate small things
/// all the time and share none of them, who would wait for each other.
void split_memory_by_threads();

/// Bytes that this process may still take: what the host has free, or less where a control group
/// (version 1 or 2) holds the process to less. 0 where the system does not say.
std::uint64_t available_memory();
/// Bytes of physical memory that this process uses now; 0 where the system does not say.
std::uint64_t resident_memory();

/// The share of the host's cores that a control group leaves to this process: 0.33 on a host of any
/// size means a third of one core. 0: no limit.
double cpu_limit();

}  // namespace meshfarm
