// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

namespace meshfarm {

/// From now on freed memory stays with the process for the next allocation: parts of a like size
/// follow each other, and fresh pages cost more than what is done with them (measured: half the CPU
/// time of a cut). Called once, before there are threads. Without glibc it does nothing.
void keep_freed_memory();

}  // namespace meshfarm
