// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "text_numbers.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace meshfarm {
namespace {

/// Accurate enough for holds_digits().
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

/// The exponent of ten of a decimal's last digit.
long last_digit(std::string_view text) {
  // The usual case: digits behind a point, and no exponent.
  std::size_t point = text.size();
  while (point > 0 && text[point - 1] >= '0' && text[point - 1] <= '9') --point;
  if (point > 0 && text[point - 1] == '.') return -static_cast<long>(text.size() - point);
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

}  // namespace

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

bool holds_digits(double near, double value, std::string_view text) {
  constexpr std::size_t k_short = 7;  // six digits and a point: any float holds them
  if (text.size() <= k_short || !std::isfinite(near) || !std::isfinite(value)) return true;
  if (std::abs(value) < static_cast<double>(std::numeric_limits<float>::min())) return true;
  constexpr double k_half_a_digit = 0.5 * (1 + 1e-9);
  // The decimal may be off by half a digit, and its nearest double by a rounding in the same
  // direction.
  const double in_double = std::abs(value) * std::numeric_limits<double>::epsilon();
  return std::abs(near - value) <= k_half_a_digit * power_of_ten(last_digit(text)) + in_double;
}

}  // namespace meshfarm
