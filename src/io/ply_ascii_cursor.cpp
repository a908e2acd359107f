// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_ascii_cursor.hpp"

#include <array>
#include <charconv>
#include <cstdlib>
#include <limits>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {
namespace {

constexpr std::ptrdiff_t k_longest_value = 256;  // longer ones are taken for no number

/// Whether a decimal that no double can hold is too near zero for it, not too large.
bool is_tiny(std::string_view text) {
  const std::size_t e = text.find_first_of("eE");
  long exponent = 0;
  if (e != std::string_view::npos) {
    const std::size_t digits = text.substr(e + 1).starts_with('+') ? e + 2 : e + 1;
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data() + digits, end, exponent);
    if (result.ec == std::errc::result_out_of_range) return text[e + 1] == '-';
  }
  const std::string_view mantissa = text.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  return exponent + static_cast<long>(point) - static_cast<long>(first) < 0;
}

/// Near enough for what it is for.
double power_of_ten(long exponent) {
  static constexpr std::array<double, 20> k_small{1,     1e-1,  1e-2,  1e-3,  1e-4,  1e-5,  1e-6,
                                                  1e-7,  1e-8,  1e-9,  1e-10, 1e-11, 1e-12, 1e-13,
                                                  1e-14, 1e-15, 1e-16, 1e-17, 1e-18, 1e-19};
  if (exponent <= 0 && -exponent < static_cast<long>(k_small.size())) {
    return k_small[static_cast<std::size_t>(-exponent)];
  }
  double power = 1;
  for (long i = std::min(std::labs(exponent), 400L); i > 0; --i) power *= exponent < 0 ? 0.1 : 10;
  return power;
}

/// The power of ten that the last digit of a decimal counts.
long last_digit(std::string_view text) {
  long decimals = 0;
  bool after_point = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((text[i] | 0x20) == 'e') {
      long exponent = 0;
      const std::size_t digits = i + (text[i + 1] == '+' ? 2 : 1);
      std::from_chars(text.data() + digits, text.data() + text.size(), exponent);
      return exponent - decimals;
    }
    decimals += after_point ? 1 : 0;
    after_point = after_point || text[i] == '.';
  }
  return -decimals;
}

/// Whether `near`, written with as many digits as `text` has for `value`, would read like that.
bool holds_digits(double near, double value, std::string_view text) {
  constexpr std::size_t k_short = 7;  // six digits and a point: any float holds them
  if (text.size() <= k_short || !std::isfinite(near) || !std::isfinite(value)) return true;
  if (std::abs(value) < static_cast<double>(std::numeric_limits<float>::min())) return true;
  constexpr double k_half_a_digit = 0.5 * (1 + 1e-9);
  return std::abs(near - value) <= k_half_a_digit * power_of_ten(last_digit(text));
}

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
    ++current_;
    ++line_;
  }
  return true;
}

bool AsciiCursor::end_record() {
  if (has_value()) return false;
  if (current_ != end_) {
    ++current_;
    ++line_;
  }
  return true;
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
    // Too near the window's end for a value to be whole in it, unless the file ends here too.
    const bool at_end = current_ == end_;
    refill(k_longest_value + 1);
    if (!at_end || current_ == end_) break;
  }
  return current_ != end_ && *current_ != line_end_;
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
  // The same limit wherever the window ends, or the result would depend on that.
  const char* limit = end_ - current_ > k_longest_value ? current_ + k_longest_value : end_;
  if (*first == '+' && end_ - first > 1 && first[1] != '-') ++first;
  T value{};
  const auto [stop, error] = std::from_chars(first, limit, value);
  if (error == std::errc::invalid_argument || !ends_value(stop)) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const std::string_view text(first, static_cast<std::size_t>(stop - first));
    if constexpr (std::is_integral_v<T>) {
      value = *first == '-' ? std::numeric_limits<T>::min() : std::numeric_limits<T>::max();
    } else {
      value = is_tiny(text) ? T{0} : std::numeric_limits<T>::infinity();
    }
  }
  current_ = stop;
  return value;
}

/// By way of a double, which tells what a float loses.
std::optional<double> AsciiCursor::parse_float() {
  const char* start = current_;
  const std::optional<double> wide = parse<double>();
  if (!wide) return wide;
  // Where the nearest float of the text is not that of its nearest double digits are lost, too.
  const double near = rounded_to_float(*wide);
  if (near != *wide && !has_lost_digits_) {
    const std::string_view text(start, static_cast<std::size_t>(current_ - start));
    has_lost_digits_ = !holds_digits(near, *wide, text);
  }
  return near;
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
