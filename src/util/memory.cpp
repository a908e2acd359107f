// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <malloc.h>

#include <meshfarm/util/memory.hpp>

namespace meshfarm {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int k_never = 1 << 30;
  ::mallopt(M_MMAP_THRESHOLD, k_never);
  ::mallopt(M_TRIM_THRESHOLD, k_never);
  ::mallopt(M_ARENA_MAX, 1);  // what one thread freed is there for the others, too
#endif
}

}  // namespace meshfarm
