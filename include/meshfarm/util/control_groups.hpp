// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What the kernel's control groups (containers, Slurm, systemd) leave to this process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace meshfarm {

/// Where the kernel describes control groups.
struct GroupView {
  std::filesystem::path process = "/proc/self";  // holds "cgroup" and "mountinfo"
  std::filesystem::path root = "/";              // stands before every mount point
};

struct GroupMemory {
  std::uint64_t room = 0;   // bytes that may still be taken
  std::uint64_t group = 0;  // names the group whose limit that is, on this host; never 0
};

/// The least room of this process's control group and all visible groups above it, of version 1
/// or 2. Inactive page cache counts as room, since the kernel drops it on demand. Nothing if no
/// group has a limit.
std::optional<GroupMemory> group_memory(const GroupView& view = {});

/// The cores that the groups leave to this process: 0.33 is a third of one core. Nothing if there
/// is no limit.
std::optional<double> group_cores(const GroupView& view = {});

/// How many threads are useful: the cores that the host, a processor set and control groups leave
/// to this process; at least 1.
unsigned processors();

}  // namespace meshfarm
