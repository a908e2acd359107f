// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_types.hpp"

#include <array>
#include <utility>

namespace meshfarm {

std::optional<PlyType> ply_type(std::string_view name) {
  using Entry = std::pair<std::string_view, PlyType>;
  static constexpr std::array<Entry, 18> k_names{{{"char", PlyType::int8},
                                                  {"int8", PlyType::int8},
                                                  {"uchar", PlyType::uint8},
                                                  {"uint8", PlyType::uint8},
                                                  {"short", PlyType::int16},
                                                  {"int16", PlyType::int16},
                                                  {"ushort", PlyType::uint16},
                                                  {"uint16", PlyType::uint16},
                                                  {"int", PlyType::int32},
                                                  {"int32", PlyType::int32},
                                                  {"uint", PlyType::uint32},
                                                  {"uint32", PlyType::uint32},
                                                  {"int64", PlyType::int64},
                                                  {"uint64", PlyType::uint64},
                                                  {"float", PlyType::float32},
                                                  {"float32", PlyType::float32},
                                                  {"double", PlyType::float64},
                                                  {"float64", PlyType::float64}}};
  for (const auto& [known, type] : k_names) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::string_view name_of(PlyType type) {
  static constexpr std::array<std::string_view, 10> k_names{
      "char", "uchar", "short", "ushort", "int", "uint", "int64", "uint64", "float", "double"};
  return k_names[static_cast<std::size_t>(type)];
}

std::optional<std::int64_t> whole_number(double value) {
  constexpr double k_two_to_63 = 9223372036854775808.0;
  if (std::trunc(value) != value) return std::nullopt;
  if (value >= k_two_to_63) return INT64_MAX;
  if (value < -k_two_to_63) return INT64_MIN;
  return static_cast<std::int64_t>(value);
}

std::string shown(std::string_view text) {
  constexpr std::size_t k_longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, k_longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > k_longest ? "...'" : "'");
}

}  // namespace meshfarm
