// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_ascii_cursor.hpp"

#include <cmath>
#include <cstring>

#include <meshfarm/geometry/mesh.hpp>

#include "text_numbers.hpp"

namespace meshfarm {
namespace {

constexpr std::ptrdiff_t k_longest_value = 256;  // longer ones count as no number

bool fits(double value, PlyType type) {
  const unsigned bits = 8 * static_cast<unsigned>(size_of(type));
  const bool is_signed = static_cast<unsigned>(type) % 2 == 0;
  const double end = std::ldexp(1.0, static_cast<int>(is_signed ? bits - 1 : bits));
  return std::trunc(value) == value && value >= (is_signed ? -end : 0.0) && value < end;
}

}  // namespace

void AsciiCursor::refill(std::size_t at_least) {
  stream_->consume(static_cast<std::size_t>(current_ - begin_));
  const std::string_view window = stream_->window(at_least);
  begin_ = current_ = window.data();
  end_ = begin_ + window.size();
}

std::string_view AsciiCursor::lines_ahead() {
  refill(ByteStream::k_max_window_bytes);
  const std::string_view ahead(current_, static_cast<std::size_t>(end_ - current_));
  return ahead.substr(0, ahead.rfind(line_end_) + 1);
}

void AsciiCursor::pass(std::size_t bytes, std::uint64_t lines) {
  current_ += bytes;
  line_ += lines;
}

bool AsciiCursor::next_record() {
  while (!has_value()) {
    if (current_ == end_) return false;
    leave_line();
  }
  return true;
}

bool AsciiCursor::end_record() {
  if (has_value()) return false;
  if (current_ != end_) leave_line();
  return true;
}

/// The line has no more values.
void AsciiCursor::leave_line() {
  if (*current_ != line_end_) return skip_record();
  ++current_;
  ++line_;
}

void AsciiCursor::skip_record() {
  while (true) {
    const auto ahead = static_cast<std::size_t>(end_ - current_);
    const void* found = ahead == 0 ? nullptr : std::memchr(current_, line_end_, ahead);
    if (found != nullptr) {
      current_ = static_cast<const char*>(found) + 1;
      ++line_;
      return;
    }
    current_ = end_;
    refill(1);
    if (current_ == end_) return;
  }
}

bool AsciiCursor::has_value() {
  while (true) {
    while (current_ != end_ && is_blank(*current_)) ++current_;
    if (end_ - current_ > k_longest_value) break;
    // A value may not be whole so near the window's end, unless the file ends here too.
    const bool at_end = current_ == end_;
    refill(k_longest_value + 1);
    if (!at_end || current_ == end_) break;
  }
  return current_ != end_ && *current_ != line_end_ && !is_at_comment();
}

void AsciiCursor::skip_value() {
  while (true) {
    while (!ends_value(current_)) ++current_;
    if (current_ != end_) return;
    refill(1);
    if (current_ == end_) return;
  }
}

template <class T>
std::optional<T> AsciiCursor::parse() {
  const char* first = current_;
  // The same limit wherever the window ends; otherwise the result would depend on it.
  const char* limit = end_ - current_ > k_longest_value ? current_ + k_longest_value : end_;
  T value{};
  const char* stop = read_number(first, limit, value);
  if (stop == nullptr || !ends_value(stop)) return std::nullopt;
  current_ = stop;
  return value;
}

/// Parses a double first, which shows what a float loses.
std::optional<double> AsciiCursor::parse_float() {
  const char* start = current_;
  const std::optional<double> wide = parse<double>();
  if (!wide) return wide;
  const std::string_view text(start, static_cast<std::size_t>(current_ - start));
  return nearest_float(*wide, text, has_lost_digits_);
}

std::optional<double> AsciiCursor::real(PlyType type) {
  if (type == PlyType::float32 && !floats_are_wide_) return parse_float();
  if (type == PlyType::float32) type = PlyType::float64;
  const char* start = current_;
  const std::optional<double> value = parse<double>();
  if (!value || type == PlyType::float64 || fits(*value, type)) return value;
  current_ = start;
  return std::nullopt;
}

std::optional<std::int64_t> AsciiCursor::whole(PlyType type) {
  if (is_integer(type)) return parse<std::int64_t>();
  const char* start = current_;
  const std::optional<double> value = parse<double>();
  const std::optional<std::int64_t> whole = value ? whole_number(*value) : std::nullopt;
  if (!whole) current_ = start;
  return whole;
}

std::string AsciiCursor::token() const {
  const char* stop = current_;
  while (!ends_value(stop)) ++stop;
  return shown({current_, static_cast<std::size_t>(stop - current_)});
}

}  // namespace meshfarm
