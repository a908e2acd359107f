// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// Reads a staged file that a message told of front to back, in pieces, when it is too big to be
/// held. What it reads is known to be the file that was meant only after expect_end().
class StagedReader {
 public:
  /// Opens it as Stage::read does.
  StagedReader(const Stage& stage, const FileRef& file);
  /// Fills the buffer with the next bytes. Throws DataError if the file ends before, IoError.
  void fill(std::span<char> buffer);
  /// Throws DataError unless everything was read and its checksum is the promised one.
  void expect_end() const;

 private:
  FileRef file_;
  std::filesystem::path path_;
  Fd fd_;
  std::uint64_t done_ = 0;
  Checksum sum_;
};

}  // namespace meshfarm
