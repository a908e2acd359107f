// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace meshfarm {

/// "1,234,567"
inline std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

/// A number in a printf format.
inline std::string number(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

inline std::string mib(std::uint64_t bytes) {
  return grouped(bytes >> 20) + " MiB";
}

inline std::string gib(std::uint64_t bytes) {
  return number(static_cast<double>(bytes) / (1 << 30), "%.1f GiB");
}

}  // namespace meshfarm
