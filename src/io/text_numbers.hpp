// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Whether a decimal that no double can hold is too small for it, not too large.
bool is_tiny(std::string_view text);

/// Whether `near`, written with as many digits as `text` has for `value`, reads as the same number.
bool holds_digits(double near, double value, std::string_view text);

/// The float nearest to `value`, which was read from `text`. Sets `has_lost_digits` where the text
/// has more digits than a float holds.
inline double nearest_float(double value, std::string_view text, bool& has_lost_digits) {
  // Digits are also lost where the text's nearest float is not that of its nearest double.
  const double near = rounded_to_float(value);
  if (near != value && !has_lost_digits) has_lost_digits = !holds_digits(near, value, text);
  return near;
}

/// Writes the fewest digits that read as the same number of this type. Takes up to
/// k_longest_coordinate bytes, and returns the end of what was written.
inline constexpr std::size_t k_longest_coordinate = 32;
inline char* write_coordinate(char* out, double value, PositionType type) {
  char* end = out + k_longest_coordinate;
  return type == PositionType::float32 ? std::to_chars(out, end, static_cast<float>(value)).ptr
                                       : std::to_chars(out, end, value).ptr;
}

/// Reads the number at the start of the text, whatever the locale. Returns its end, or null if
/// there is no number. Numbers out of range become the end of the range, infinity or 0. `first`
/// must be before `limit`.
template <class T>
const char* read_number(const char* first, const char* limit, T& value) {
  if (*first == '+' && limit - first > 1 && first[1] != '-') ++first;
  const auto [stop, error] = std::from_chars(first, limit, value);
  if (error == std::errc::invalid_argument) return nullptr;
  if (error == std::errc::result_out_of_range) {
    const std::string_view text(first, static_cast<std::size_t>(stop - first));
    if constexpr (std::is_integral_v<T>) {
      value = *first == '-' ? std::numeric_limits<T>::min() : std::numeric_limits<T>::max();
    } else {
      value = is_tiny(text) ? T{0} : std::numeric_limits<T>::infinity();
    }
  }
  return stop;
}

}  // namespace meshfarm
