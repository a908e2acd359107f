// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <malloc.h>
#include <unistd.h>

#include <meshfarm/util/memory.hpp>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_unlimited = std::numeric_limits<std::uint64_t>::max();

/// The folder of this process's control group of a version 1 controller, or of version 2 (""); a
/// container sees its own as the root. Empty if there is none.
std::string group_folder(const std::string& controller) {
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // number:controllers:path
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    if (controllers.find("," + controller + ",") == std::string::npos) continue;
    const std::string root = "/sys/fs/cgroup" + (controller.empty() ? "" : "/" + controller);
    std::error_code ignored;
    const std::string folder = root + line.substr(second + 1);
    return std::filesystem::is_directory(folder, ignored) ? folder : root;
  }
  return {};
}

/// The number that the file begins with; "max" and what cannot be read is no limit.
std::uint64_t number_in(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  return file >> number ? number : k_unlimited;
}

std::uint64_t group_room(const std::string& limit_file, const std::string& usage_file) {
  const std::uint64_t limit = number_in(limit_file);
  const std::uint64_t usage = number_in(usage_file);
  if (limit == k_unlimited || usage == k_unlimited) return k_unlimited;
  return limit > usage ? limit - usage : 0;
}

std::uint64_t host_room() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    std::uint64_t kib = 0;
    if (words >> name >> kib && name == "MemAvailable:") return kib * 1024;
  }
  return k_unlimited;
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

void split_memory_by_threads() {
#ifdef __GLIBC__
  ::mallopt(M_ARENA_MAX, 0);  // as many as it likes
#endif
}

std::uint64_t available_memory() {
  const std::string old_group = group_folder("memory");
  const std::string group = group_folder("");
  const std::uint64_t room = std::min(
      {host_room(),
       group_room(old_group + "/memory.limit_in_bytes", old_group + "/memory.usage_in_bytes"),
       group_room(group + "/memory.max", group + "/memory.current")});
  return room == k_unlimited ? 0 : room;
}

std::uint64_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0;
  std::uint64_t resident = 0;
  if (!(file >> all >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

double cpu_limit() {
  const std::string old_group = group_folder("cpu");
  std::uint64_t quota = number_in(old_group + "/cpu.cfs_quota_us");  // -1: none
  std::uint64_t period = number_in(old_group + "/cpu.cfs_period_us");
  std::ifstream group(group_folder("") + "/cpu.max");  // "33000 100000" or "max 100000"
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  if (group >> first >> second) {
    quota = first;
    period = second;
  }
  const bool limited = quota < k_unlimited / 2 && period > 0 && period != k_unlimited;
  return limited ? static_cast<double>(quota) / static_cast<double>(period) : 0;
}

}  // namespace meshfarm
