// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "scratch_array.hpp"

namespace meshfarm {

/// Items whose number is not known in advance: the first 48 MB in memory, more in scratch files
/// like those of ScratchArray.
template <class T>
class ScratchList {
 public:
  std::uint64_t size() const { return count_; }
  T& operator[](std::uint64_t i) { return chunks_[i / k_chunk].items()[i % k_chunk]; }
  /// Throws IoError.
  void push_back(const T& item) {
    if (count_ == chunks_.size() * k_chunk) {
      chunks_.emplace_back(k_chunk, chunks_.empty() ? UINT64_MAX : 0);
    }
    (*this)[count_++] = item;
  }
  /// To be called after `count` uses, as for a ScratchArray.
  void used(std::size_t count) {
    for (ScratchArray<T>& chunk : chunks_) chunk.used(count);
  }

 private:
  static constexpr std::uint64_t k_chunk = ScratchArray<T>::k_most_in_memory / sizeof(T);
  std::vector<ScratchArray<T>> chunks_;
  std::uint64_t count_ = 0;
};

}  // namespace meshfarm
