// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace meshfarm {

/// Where a child's words go; empty: where its parent's do.
struct ChildOutput {
  std::filesystem::path out;
  std::filesystem::path err;
};

/// Starts this program with these words, a command's name first: in a process group of its own, so
/// that Ctrl-C reaches the parent only, and ended with its parent. Throws IoError.
pid_t start_child(const std::vector<std::string>& words, const ChildOutput& output = {});

/// Sleeps until a child ends, a signal comes, or the time is over. From the first start_child() on.
void wait_for_child(int timeout_ms);

}  // namespace meshfarm
