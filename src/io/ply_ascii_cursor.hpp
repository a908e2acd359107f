// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "byte_stream.hpp"
#include "ply_types.hpp"

namespace meshfarm {

/// Walks over text: lines, and within them values separated by blanks. Independent of the locale;
/// allocates nothing per line.
class AsciiCursor {
 public:
  AsciiCursor(std::unique_ptr<ByteStream> stream, char line_end, std::uint64_t line)
      : stream_(std::move(stream)), line_end_(line_end), line_(line) {}

  /// From now on, skips comments: from a '#' that begins a value to the end of its line.
  void pass_comments() { has_comments_ = true; }

  /// The number of the current line, from 1.
  std::uint64_t line() const { return line_; }

  /// The cursor's position in the stream.
  std::uint64_t position() const {
    return stream_->position() + static_cast<std::uint64_t>(current_ - begin_);
  }

  /// The whole lines ahead, as many as one window holds; nothing if the first is too long for that.
  /// Valid until the cursor moves, except by pass().
  std::string_view lines_ahead();
  /// Skips the first `bytes` bytes of those, which have `lines` lines.
  void pass(std::size_t bytes, std::uint64_t lines);

  /// Goes to the next line that is not blank. False if there is none.
  bool next_record();
  /// Leaves the current line. False if it has more values.
  bool end_record();
  /// Leaves the current line, whatever is left of it.
  void skip_record();

  /// Whether the current line has another value; stops in front of it.
  bool has_value();
  /// The value ahead. Nothing if it is not of the type asked for; token() then has its text.
  std::optional<double> real(PlyType type);
  /// From now on, floats are read as doubles.
  void read_floats_wide() { floats_are_wide_ = true; }
  /// Whether any float so far had more digits than a float holds.
  bool has_lost_digits() const { return has_lost_digits_; }
  std::optional<std::int64_t> whole(PlyType type);
  void skip_value();
  std::string token() const;

 private:
  bool is_blank(char c) const { return c != line_end_ && (c == ' ' || (c >= '\t' && c <= '\r')); }
  bool ends_value(const char* at) const { return at == end_ || *at == line_end_ || is_blank(*at); }
  bool is_at_comment() const { return has_comments_ && *current_ == '#'; }
  void leave_line();
  void refill(std::size_t at_least);
  template <class T>
  std::optional<T> parse();
  std::optional<double> parse_float();

  std::unique_ptr<ByteStream> stream_;
  char line_end_;
  std::uint64_t line_;
  bool has_comments_ = false;
  bool floats_are_wide_ = false;
  bool has_lost_digits_ = false;
  const char* begin_ = nullptr;  // the stream's window
  const char* current_ = nullptr;
  const char* end_ = nullptr;
};

}  // namespace meshfarm
