// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "byte_stream.hpp"

namespace meshfarm {

/// Text in memory.
class TextStream final : public ByteStream {
 public:
  explicit TextStream(std::string_view text) : begin_(text.data()) {
    current_ = begin_;
    end_ = begin_ + text.size();
  }
  std::uint64_t position() const override { return static_cast<std::uint64_t>(current_ - begin_); }
  std::optional<std::uint64_t> remaining() const override {
    return static_cast<std::uint64_t>(end_ - current_);
  }

 private:
  void widen(std::size_t /*at_least*/) override {}
  bool jump(std::uint64_t /*count*/) override {
    current_ = end_;
    return false;
  }
  const char* begin_;
};

/// Divides text into `pieces` pieces of about equal size, each of whole lines; fewer if lines are
/// long.
inline std::vector<std::string_view> pieces_of(std::string_view text, std::size_t pieces,
                                               char line_end) {
  std::vector<std::string_view> made;
  for (std::size_t left = pieces; !text.empty(); --left) {
    std::size_t size = text.size();
    if (left > 1) size = std::min(size, text.find(line_end, text.size() / left) + 1);
    if (size == 0) size = text.size();
    made.push_back(text.substr(0, size));
    text.remove_prefix(size);
    if (left == 1) break;
  }
  return made;
}

}  // namespace meshfarm
