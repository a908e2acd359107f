// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

namespace meshfarm {

/// Calls work(0) ... work(count - 1), each once, on up to `threads` threads (0: one per core), in
/// no particular order. If calls throw, the exception of the lowest index is thrown at the end.
void parallel_for(std::uint64_t count, unsigned threads,
                  const std::function<void(std::uint64_t)>& work);

}  // namespace meshfarm
