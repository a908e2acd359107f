// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sys/mman.h>

#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// Items, initially zero, that are written and read in any order: a limited number in memory, more
/// in a scratch file without a name in $TMPDIR (or /tmp).
template <class T>
class ScratchArray {
 public:
  static constexpr std::uint64_t k_most_in_memory = std::uint64_t{48} << 20;  // bytes

  ScratchArray() = default;
  /// Throws IoError.
  explicit ScratchArray(std::uint64_t count, std::uint64_t most_in_memory = k_most_in_memory) {
    is_in_memory_ = count <= most_in_memory / sizeof(T);
    if (is_in_memory_) {
      map_ = MappedFile::memory(count * sizeof(T));
      return;
    }
    map_ = MappedFile::scratch(temporary_folder(), count * sizeof(T));
  }

  std::span<T> items() { return map_.as_span<T>(); }
  std::uint64_t size() { return items().size(); }

  /// To be called after `count` uses. Now and then it unloads the pages of the scratch file: they
  /// stay in the page cache as long as there is room, and count as no process's memory.
  void used(std::size_t count) {
    constexpr std::size_t k_seldom = std::size_t{4} << 20;
    since_ += count;
    if (since_ < k_seldom || is_in_memory_) return;
    since_ = 0;
    const std::span<T> all = items();
    ::madvise(all.data(), all.size_bytes(), MADV_DONTNEED);  // advice: nothing is lost
  }

 private:
  MappedFile map_;
  bool is_in_memory_ = true;
  std::size_t since_ = 0;
};

}  // namespace meshfarm
