// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/stat.h>

#include <meshfarm/util/control_groups.hpp>

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

/// Version 1 expresses "no limit" by a number near the maximum.
constexpr std::uint64_t k_no_limit = std::uint64_t{1} << 62;

enum class Version { one, two };

/// A folder in a controller's tree, and the version of its files.
struct Group {
  fs::path folder;
  Version version = Version::two;
};

/// The number at the start of the file; nothing for "max", a negative number or an unreadable file.
std::optional<std::uint64_t> number_in(const fs::path& path) {
  std::ifstream file(path);
  std::int64_t number = 0;
  if (!(file >> number) || number < 0) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

/// The number in a line "name number" of the file.
std::optional<std::uint64_t> named_number(const fs::path& path, const std::string& wanted) {
  std::ifstream file(path);
  std::string name;
  for (std::uint64_t number = 0; file >> name >> number;) {
    if (name == wanted) return number;
  }
  return std::nullopt;
}

bool lists(const std::string& commas, const std::string& word) {
  return ("," + commas + ",").find("," + word + ",") != std::string::npos;
}

/// This process's path in a controller's tree of version 1, or in that of version 2 ("").
std::optional<std::string> group_path(const GroupView& view, const std::string& controller) {
  std::ifstream groups(view.process / "cgroup");
  for (std::string line; std::getline(groups, line);) {  // number:controllers:path
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool found = controller.empty() ? controllers.empty() : lists(controllers, controller);
    if (found) return line.substr(second + 1);
  }
  return std::nullopt;
}

/// The part of `path` below `top`; nothing if it is not below.
std::optional<std::string> below(const std::string& path, const std::string& top) {
  if (top == "/") return path;
  if (path.compare(0, top.size(), top) != 0) return std::nullopt;
  if (path.size() > top.size() && path[top.size()] != '/') return std::nullopt;
  return path.substr(top.size());
}

/// This process's group and those above it, as far as they are mounted here: a container may see
/// its own group as the top, or not even that.
std::vector<Group> groups_of(const GroupView& view, const std::string& controller) {
  const auto path = group_path(view, controller);
  if (!path) return {};
  std::ifstream mounts(view.process / "mountinfo");
  for (std::string line; std::getline(mounts, line);) {
    // id parent device top mount-point options [more]... - type source options
    std::istringstream words(line);
    std::string skipped;
    std::string top;
    std::string point;
    std::string type;
    std::string options;
    words >> skipped >> skipped >> skipped >> top >> point;
    while (words >> skipped && skipped != "-") {
    }
    words >> type >> skipped >> options;
    const bool ours =
        controller.empty() ? type == "cgroup2" : type == "cgroup" && lists(options, controller);
    if (!ours) continue;
    const Version version = controller.empty() ? Version::two : Version::one;
    const fs::path mounted = view.root / fs::path(point).relative_path();
    fs::path folder = mounted / fs::path(below(*path, top).value_or("")).relative_path();
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) folder = mounted;
    std::vector<Group> groups = {{folder, version}};
    while (folder != mounted && folder.has_relative_path()) {
      folder = folder.parent_path();
      groups.push_back({folder, version});
    }
    return groups;
  }
  return {};
}

/// Visits the groups of version 1 and 2: a host may have both.
void for_each_group(const GroupView& view, const std::string& controller,
                    const std::function<void(const Group&)>& look) {
  for (const std::string& tree : {controller, std::string()}) {
    for (const Group& group : groups_of(view, tree)) look(group);
  }
}

std::uint64_t memory_limit(const Group& group) {
  const auto limit = [&](const char* file) {
    return number_in(group.folder / file).value_or(k_no_limit);
  };
  if (group.version == Version::two) return std::min(limit("memory.max"), limit("memory.high"));
  // The second includes groups above that a container does not see.
  return std::min(
      limit("memory.limit_in_bytes"),
      named_number(group.folder / "memory.stat", "hierarchical_memory_limit").value_or(k_no_limit));
}

struct LimitedRoom {
  std::uint64_t limit = 0;
  std::uint64_t room = 0;
};

std::optional<LimitedRoom> memory_room(const Group& group) {
  const std::uint64_t limit = memory_limit(group);
  if (limit >= k_no_limit) return std::nullopt;
  const bool two = group.version == Version::two;
  const auto usage = number_in(group.folder / (two ? "memory.current" : "memory.usage_in_bytes"));
  if (!usage) return std::nullopt;
  const fs::path stat = group.folder / "memory.stat";
  auto cache = named_number(stat, two ? "inactive_file" : "total_inactive_file");
  if (!cache && !two) cache = named_number(stat, "inactive_file");
  const std::uint64_t used = *usage - std::min(*usage, cache.value_or(0));
  return LimitedRoom{limit, limit - std::min(limit, used)};
}

std::optional<double> core_limit(const Group& group) {
  double quota = 0;
  double period = 0;
  if (group.version == Version::two) {
    std::ifstream file(group.folder / "cpu.max");  // "33000 100000" or "max 100000"
    if (!(file >> quota >> period)) return std::nullopt;
  } else {
    const auto each = number_in(group.folder / "cpu.cfs_quota_us");  // -1: none
    if (!each) return std::nullopt;
    quota = static_cast<double>(*each);
    period = static_cast<double>(number_in(group.folder / "cpu.cfs_period_us").value_or(0));
  }
  if (!(quota > 0) || !(period > 0)) return std::nullopt;
  return quota / period;
}

/// The folder's inode: unique per group, whatever name a container sees it under.
std::uint64_t name_of(const Group& group) {
  struct stat status {};
  const bool known = ::stat(group.folder.c_str(), &status) == 0 && status.st_ino != 0;
  return known ? status.st_ino : 1;
}

}  // namespace

std::optional<GroupMemory> group_memory(const GroupView& view) {
  std::optional<GroupMemory> least;
  std::uint64_t limit = 0;
  for_each_group(view, "memory", [&](const Group& group) {
    const auto of = memory_room(group);
    if (!of) return;
    // Slurm gives a job, its steps and its tasks the same limit. The job fills up first, since it
    // contains all the others, but the counts are read one after another and may disagree for a
    // moment. Yet the job's workers must name the same group.
    const bool holds_the_least = least && of->limit <= limit;
    if (least && !holds_the_least && of->room >= least->room) return;
    least = GroupMemory{least ? std::min(of->room, least->room) : of->room, name_of(group)};
    limit = of->limit;
  });
  return least;
}

std::optional<double> group_cores(const GroupView& view) {
  std::optional<double> least;
  for_each_group(view, "cpu", [&](const Group& group) {
    const auto cores = core_limit(group);
    if (cores && (!least || *cores < *least)) least = cores;
  });
  return least;
}

unsigned processors() {
  const unsigned host = std::max(1U, std::thread::hardware_concurrency());
  const auto cores = group_cores();
  // A fraction of a core still needs a thread.
  return cores && *cores < host ? static_cast<unsigned>(std::max(1.0, std::ceil(*cores))) : host;
}

}  // namespace meshfarm
