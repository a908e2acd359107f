// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

enum class PlyType : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

enum class PlyFormat : std::uint8_t { ascii, binary_little, binary_big };

/// "char", "uint8", "float", ... Nothing for an unknown name.
std::optional<PlyType> ply_type(std::string_view name);
std::string_view name_of(PlyType type);

constexpr std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    default:
      return 8;
  }
}

constexpr bool is_integer(PlyType type) {
  return type != PlyType::float32 && type != PlyType::float64;
}

/// A value as stored in a binary file.
template <class T, std::endian Order>
T load_ply(const char* bytes) {
  char raw[sizeof(T)];
  std::memcpy(raw, bytes, sizeof(T));
  if constexpr (Order != std::endian::native) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

/// Calls `use` with the value of `type` at `bytes`.
template <std::endian Order, class Use>
auto with_ply_value(PlyType type, const char* bytes, Use&& use) {
  switch (type) {
    case PlyType::int8:
      return use(load_ply<std::int8_t, Order>(bytes));
    case PlyType::uint8:
      return use(load_ply<std::uint8_t, Order>(bytes));
    case PlyType::int16:
      return use(load_ply<std::int16_t, Order>(bytes));
    case PlyType::uint16:
      return use(load_ply<std::uint16_t, Order>(bytes));
    case PlyType::int32:
      return use(load_ply<std::int32_t, Order>(bytes));
    case PlyType::uint32:
      return use(load_ply<std::uint32_t, Order>(bytes));
    case PlyType::int64:
      return use(load_ply<std::int64_t, Order>(bytes));
    case PlyType::uint64:
      return use(load_ply<std::uint64_t, Order>(bytes));
    case PlyType::float32:
      return use(load_ply<float, Order>(bytes));
    default:
      return use(load_ply<double, Order>(bytes));
  }
}

template <std::endian Order>
double load_real(PlyType type, const char* bytes) {
  return with_ply_value<Order>(type, bytes, [](auto value) { return static_cast<double>(value); });
}

/// `value` as a whole number. Nothing if it is not whole; one that exceeds 64 signed bits, and so
/// any count or index, becomes the largest.
std::optional<std::int64_t> whole_number(double value);

template <std::endian Order>
std::optional<std::int64_t> load_whole(PlyType type, const char* bytes) {
  return with_ply_value<Order>(type, bytes, [](auto value) -> std::optional<std::int64_t> {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      return whole_number(static_cast<double>(value));
    } else if constexpr (std::is_same_v<decltype(value), std::uint64_t>) {
      return static_cast<std::int64_t>(std::min<std::uint64_t>(value, INT64_MAX));
    } else {
      return value;
    }
  });
}

/// Text from a file, made fit for a message: short and printable.
std::string shown(std::string_view text);

}  // namespace meshfarm
