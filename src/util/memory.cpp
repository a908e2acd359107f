// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include <malloc.h>
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

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int k_never = 1 << 30;
  ::mallopt(M_MMAP_THRESHOLD, k_never);
  ::mallopt(M_TRIM_THRESHOLD, k_never);
  ::mallopt(M_ARENA_MAX, 1);  // what one thread freed is there for the others, too
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
