// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace meshfarm {

/// Files for a child's output; empty: same as the parent's.
struct ChildOutput {
  std::filesystem::path out;
  std::filesystem::path err;
};

/// Starts this program with these words, starting with a command's name, in a process group of its
/// own, so that Ctrl-C reaches only the parent. The child ends with its parent. Throws IoError.
pid_t start_child(const std::vector<std::string>& words, const ChildOutput& output = {});

/// Sleeps until a child ends, a signal arrives, or the timeout is over. Call after start_child().
void wait_for_child(int timeout_ms);

}  // namespace meshfarm
