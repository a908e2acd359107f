// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/memory.hpp>

namespace meshfarm {
namespace {

std::optional<std::uint64_t> host_room() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    std::uint64_t kib = 0;
    if (words >> name >> kib && name == "MemAvailable:") return kib * 1024;
  }
  return std::nullopt;
}

/// Grows the heap at once, and requests large pages for it: with small pages its first use costs
/// more than the work done there (12 us per page on a virtual machine, a tenth of a short job).
void grow_heap_by_large_pages() {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr int k_growth = 256 << 20;  // addresses, not memory
  constexpr int k_usual_growth = 128 << 10;
  constexpr std::size_t k_more_than_is_left = 1 << 20;
  ::mallopt(M_TOP_PAD, k_growth);
  auto* const begin = static_cast<char*>(std::malloc(k_more_than_is_left));
  ::mallopt(M_TOP_PAD, k_usual_growth);
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const auto end = reinterpret_cast<std::uintptr_t>(::sbrk(0));
  // Otherwise malloc is not the C library's, or there is not enough address space.
  if (begin != nullptr && first < end && end - first >= k_growth && end - first < 2ULL * k_growth) {
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const std::uintptr_t skipped = (page - first % page) % page;
    // Without large pages nothing changes.
    static_cast<void>(::madvise(begin + skipped, end - first - skipped, MADV_HUGEPAGE));
  }
  std::free(begin);
#endif
}

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int k_never = 1 << 30;
  ::mallopt(M_MMAP_THRESHOLD, k_never);
  ::mallopt(M_TRIM_THRESHOLD, k_never);
  ::mallopt(M_ARENA_MAX, 1);  // memory freed by one thread is available to the others, too
  grow_heap_by_large_pages();
#endif
}

std::optional<MemoryRoom> available_memory() {
  const auto host = host_room();
  const auto group = group_memory();
  if (group && (!host || group->room < *host)) return MemoryRoom{group->room, group->group};
  if (!host) return std::nullopt;
  return MemoryRoom{*host, k_whole_host};
}

std::uint64_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0;
  std::uint64_t resident = 0;
  if (!(file >> all >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace meshfarm
