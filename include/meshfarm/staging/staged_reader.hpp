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

/// Reads a staged file that a message named, front to back, in pieces, when it does not fit into
/// memory. Only expect_end() confirms that the content is that of the intended file.
class StagedReader {
 public:
  /// Opens the file like Stage::read.
  StagedReader(const Stage& stage, const FileRef& file);
  /// Fills the buffer with the next bytes. Throws DataError if the file is too short, IoError.
  void fill(std::span<char> buffer);
  /// Throws DataError unless everything was read and its checksum is the expected one.
  void expect_end() const;

 private:
  FileRef file_;
  std::filesystem::path path_;
  Fd fd_;
  std::uint64_t done_ = 0;
  Checksum sum_;
};

}  // namespace meshfarm
