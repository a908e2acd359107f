// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "byte_stream.hpp"
#include "scratch_file.hpp"

namespace meshfarm {

/// Bytes that can be read from anywhere, as often as wanted.
struct GltfBuffer {
  std::uint64_t size = 0;
  /// Within the size. Throws IoError, and DataError if the file has become shorter.
  std::function<void(std::uint64_t offset, std::span<char> out)> read;
};

/// Of bytes in memory, and of those of a scratch file from `start` on.
GltfBuffer buffer_in_memory(std::string bytes);
GltfBuffer buffer_in_scratch(std::shared_ptr<const ScratchFile> scratch, std::uint64_t start,
                             std::uint64_t size);

/// Keeps bytes: the first 16 MiB in memory, all that is more in one scratch file without a name in
/// $TMPDIR (or /tmp).
class GltfStore {
 public:
  /// Throws IoError.
  GltfBuffer keep(std::string bytes);

 private:
  std::uint64_t in_memory_ = 0;
  std::uint64_t in_scratch_ = 0;
  std::shared_ptr<const ScratchFile> scratch_;
};

/// Files of which those that were read last are open.
class GltfFiles {
 public:
  static constexpr std::size_t k_most_open = 8;

  /// Throws IoError or DataError as InputFile does.
  std::shared_ptr<const InputFile> open(const std::filesystem::path& path);

 private:
  std::vector<std::shared_ptr<const InputFile>> open_;  // the last one last
};

/// Of a file, which is opened where it must be: at once, and when it is read. It is a DataError if
/// its size is another one then.
GltfBuffer buffer_in_file(const std::shared_ptr<GltfFiles>& files,
                          const std::filesystem::path& path);

}  // namespace meshfarm
