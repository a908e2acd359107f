// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <meshfarm/util/side_thread.hpp>

namespace meshfarm {

/// A text file of a run that others read while it grows: one writer, whole lines, append-only. A
/// thread of its own writes it, so that stalled or full storage never blocks the caller: lines that
/// cannot be written are kept, and retried from time to time. Lines are dropped only if too many
/// wait.
class LineLog {
 public:
  /// Creates the file, and its folder if missing.
  explicit LineLog(std::filesystem::path path);
  /// Waits at most a few seconds until everything is written.
  ~LineLog();
  LineLog(const LineLog&) = delete;
  LineLog& operator=(const LineLog&) = delete;

  /// Adds a line; its newline is appended here. Others see it within about a second.
  void add(std::string_view line);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::optional<SideThread> thread_;
};

}  // namespace meshfarm
