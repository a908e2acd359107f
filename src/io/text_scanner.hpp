// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

#include "ply_types.hpp"
#include "text_blocks.hpp"
#include "text_numbers.hpp"

namespace meshfarm {

/// Walks over text that is completely in memory: lines, and within them values separated by blanks.
/// '#' begins a comment, and a backslash at the end of a line joins the next line to it. Throws
/// TextError.
class TextScanner {
 public:
  TextScanner(std::string_view text, char line_end)
      : at_(text.data()), end_(text.data() + text.size()), line_end_(line_end) {
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";  // some editors begin UTF-8 so
    if (text.starts_with(k_byte_order_mark)) at_ += k_byte_order_mark.size();
  }

  bool at_end() const { return at_ == end_; }
  const char* at() const { return at_; }

  /// Whether the current line has another value; stops in front of it.
  bool has_value() {
    while (true) {
      while (at_ != end_ && is_blank(*at_)) ++at_;
      if (at_ == end_ || *at_ == line_end_ || *at_ == '#') return false;
      if (*at_ != '\\' || !joins_lines(at_)) return true;
      at_ = std::find(at_, end_, line_end_);
      if (at_ != end_) ++at_;
    }
  }
  /// Goes to the next value, on any line. False if there is none.
  bool next_value() {
    while (!has_value()) {
      if (at_ == end_) return false;
      next_line();
    }
    return true;
  }
  /// Leaves the current line, and the lines joined to it.
  void next_line() {
    while (true) {
      const char* start = at_;
      const auto ahead = static_cast<std::size_t>(end_ - at_);
      const void* found = ahead == 0 ? nullptr : std::memchr(at_, line_end_, ahead);
      if (found == nullptr) {
        at_ = end_;
        return;
      }
      at_ = static_cast<const char*>(found) + 1;
      if (!is_joined(start, at_ - 1)) return;
    }
  }

  /// The value ahead, which must exist.
  std::string_view word() {
    const char* start = at_;
    while (!ends_value(at_)) ++at_;
    if (at_ == start) ++at_;  // a backslash
    return {start, static_cast<std::size_t>(at_ - start)};
  }
  void skip_word() {
    if (!has_value()) fail_short();
    word();
  }
  /// A coordinate. `wide`: as a double, else as a float, which may lose digits.
  double real(bool wide) {
    if (!has_value()) fail_short();
    double value = 0;
    const char* start = at_;
    const char* stop = read_number(start, limit(), value);
    if (stop == nullptr || !ends_value(stop)) fail("the coordinate " + token() + " is no number");
    at_ = stop;
    if (wide) return value;
    return nearest_float(value, {start, static_cast<std::size_t>(stop - start)}, has_lost_digits_);
  }
  bool has_lost_digits() const { return has_lost_digits_; }

  bool ends_value(const char* at) const {
    return at == end_ || is_blank(*at) || *at == line_end_ || *at == '#' || *at == '\\';
  }
  /// The latest end of a number that begins here.
  const char* limit() const { return end_ - at_ > k_longest_value ? at_ + k_longest_value : end_; }
  void go_to(const char* at) { at_ = at; }

  /// The value ahead, without consuming it.
  std::string_view peek() {
    const char* start = at_;
    const std::string_view text = word();
    at_ = start;
    return text;
  }
  std::string token() { return shown(peek()); }
  [[noreturn]] void fail(const std::string& why) const { throw TextError{at_, why}; }
  [[noreturn]] void fail_short() const { fail("the line ends before its last value"); }

  /// Whether the line from `start` to `line_end` ends with a backslash outside a comment: those in
  /// comments may be paths.
  static bool is_joined(const char* start, const char* line_end) {
    if (line_end != start && line_end[-1] == '\r') --line_end;
    if (line_end == start || line_end[-1] != '\\') return false;
    return std::find(start, line_end, '#') == line_end;
  }

 private:
  bool is_blank(char c) const { return c == ' ' || (c >= '\t' && c <= '\r' && c != line_end_); }
  bool joins_lines(const char* backslash) const {
    const char* next = backslash + 1;
    if (next != end_ && *next == '\r' && line_end_ != '\r') ++next;
    return next == end_ || *next == line_end_;
  }

  static constexpr std::ptrdiff_t k_longest_value = 256;  // longer ones count as no number
  const char* at_;
  const char* end_;
  char line_end_;
  bool has_lost_digits_ = false;
};

}  // namespace meshfarm
