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

/// Bytes with random access, which can be read any number of times.
struct GltfBuffer {
  std::uint64_t size = 0;
  /// The range must lie within the size. Throws IoError, and DataError if the file has become
  /// shorter.
  std::function<void(std::uint64_t offset, std::span<char> out)> read;
};

/// From bytes in memory, and from those of a scratch file from `start` on.
GltfBuffer buffer_in_memory(std::string bytes);
GltfBuffer buffer_in_scratch(std::shared_ptr<const ScratchFile> scratch, std::uint64_t start,
                             std::uint64_t size);

/// Keeps bytes: the first 16 MiB in memory, the rest in one scratch file without a name in $TMPDIR
/// (or /tmp).
class GltfStore {
 public:
  /// Throws IoError.
  GltfBuffer keep(std::string bytes);

 private:
  std::uint64_t in_memory_ = 0;
  std::uint64_t in_scratch_ = 0;
  std::shared_ptr<const ScratchFile> scratch_;
};

/// Keeps the files open that were read last.
class GltfFiles {
 public:
  static constexpr std::size_t k_most_open = 8;

  /// Throws IoError or DataError as InputFile does.
  std::shared_ptr<const InputFile> open(const std::filesystem::path& path);

 private:
  std::vector<std::shared_ptr<const InputFile>> open_;  // most recently used last
};

/// From a file, which is opened now, and again, if need be, when it is read. It is a DataError if
/// its size has changed by then.
GltfBuffer buffer_in_file(const std::shared_ptr<GltfFiles>& files,
                          const std::filesystem::path& path);

}  // namespace meshfarm
