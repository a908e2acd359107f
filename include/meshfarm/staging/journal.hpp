// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// An append-only log with one writer; each incarnation of the writer starts a new one.
class JournalWriter {
 public:
  /// Creates the file; it must not exist. Throws IoError.
  explicit JournalWriter(std::filesystem::path path);
  /// Returns once the record is on the disk.
  void append(std::string_view record);
  /// Appends many records at the cost of one: they are written and synced together.
  void append_all(std::span<const std::string> records);

 private:
  std::filesystem::path path_;
  Fd fd_;
};

struct JournalContent {
  std::vector<std::string> records;
  std::uint64_t torn_bytes = 0;  // at the end, after the last whole record
};

/// The whole records, in order; a torn or damaged tail is dropped and counted.
/// Throws DataError if the file is no journal at all.
JournalContent parse_journal(std::string_view bytes, std::string_view what);

}  // namespace meshfarm
