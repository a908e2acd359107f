// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// Writes sections one after another. Readers must be told where the sections are: the file does
/// not contain it.
class SectionWriter {
 public:
  explicit SectionWriter(std::function<void(std::string_view)> write) : write_(std::move(write)) {}
  FileSection add(std::string_view bytes);

 private:
  std::function<void(std::string_view)> write_;
  std::uint64_t written_ = 0;
};

/// Reads sections of a staged file that a message named. Safe from several threads.
class SectionedFile {
 public:
  /// Opens the file like Stage::read; only its size is checked.
  SectionedFile(const Stage& stage, const FileRef& file);
  /// Throws UnreadDataError for a section that is damaged or beyond the file's end, UnreadIoError.
  std::string read(const FileSection& section) const;

 private:
  std::filesystem::path path_;
  std::uint64_t size_;
  Fd fd_;
};

}  // namespace meshfarm
