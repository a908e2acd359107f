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

/// Writes sections one behind the other. Who reads them must be told where they are: the file does
/// not say it.
class SectionWriter {
 public:
  explicit SectionWriter(std::function<void(std::string_view)> write) : write_(std::move(write)) {}
  FileSection add(std::string_view bytes);

 private:
  std::function<void(std::string_view)> write_;
  std::uint64_t written_ = 0;
};

/// Reads sections of a staged file that a message told of. May be asked by several threads.
class SectionedFile {
 public:
  /// Opens it as Stage::read does; only its size is checked.
  SectionedFile(const Stage& stage, const FileRef& file);
  /// Throws UnreadDataError for a section that is damaged or beyond the file's end, UnreadIoError.
  std::string read(const FileSection& section) const;

 private:
  std::filesystem::path path_;
  std::uint64_t size_;
  Fd fd_;
};

}  // namespace meshfarm
