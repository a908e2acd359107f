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

/// A text file of a run that others read while it grows: one writer, whole lines, only appended to.
/// Written by a thread of its own, so that storage that stalls or is full never holds up the
/// writer: what cannot be written is kept, and tried again now and then. Lines are dropped only
/// where too many wait.
class LineLog {
 public:
  /// Makes the file, and its folder where that is missing.
  explicit LineLog(std::filesystem::path path);
  /// Waits for a few seconds at most until what is there is written.
  ~LineLog();
  LineLog(const LineLog&) = delete;
  LineLog& operator=(const LineLog&) = delete;

  /// The line gets its end here. Others see it within about a second.
  void add(std::string_view line);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::optional<SideThread> thread_;
};

}  // namespace meshfarm
