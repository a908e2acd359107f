// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A scratch file without a name that several threads read and write at given offsets. It is not
/// mapped: we cannot control how much the kernel maps at a time, and mapped pages count as memory.
class PageFile {
 public:
  /// Throws IoError, as do the other functions, for example if the disk is full.
  explicit PageFile(const std::filesystem::path& folder);
  /// Bytes that were never written are zero.
  void read(std::uint64_t offset, std::span<char> out) const;
  void write(std::uint64_t offset, std::span<const char> bytes) const;

 private:
  std::filesystem::path folder_;  // for messages
  Fd fd_;
};

}  // namespace meshfarm
