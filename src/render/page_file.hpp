// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// A scratch file without a name that several threads read and write by place. It is not mapped:
/// how much the kernel maps at a time is not ours to decide, and mapped pages count as memory.
class PageFile {
 public:
  /// Throws IoError, and so do the others, for a full disk, say.
  explicit PageFile(const std::filesystem::path& folder);
  /// What was not written is zero.
  void read(std::uint64_t offset, std::span<char> out) const;
  void write(std::uint64_t offset, std::span<const char> bytes) const;

 private:
  std::filesystem::path folder_;  // for messages
  Fd fd_;
};

}  // namespace meshfarm
