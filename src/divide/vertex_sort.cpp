// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/vertex_sort.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace meshfarm {
namespace {

struct Key {
  std::uint64_t key;
  std::uint32_t index;
};

/// The bits of a number as an integer with the same order; -0 equals 0.
std::uint32_t ordered_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0F);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000U;
}
std::uint64_t ordered_bits(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x + 0.0);
  return (bits >> 63) != 0 ? ~bits : bits | (std::uint64_t{1} << 63);
}

/// A key with the order of the positions, as far as it goes: two coordinates of floats, one of
/// doubles.
std::uint64_t key_of(Vec3 p, const SweepOrder& order, PositionType type) {
  if (type == PositionType::float64) return ordered_bits(order.along(p));
  return std::uint64_t{ordered_bits(static_cast<float>(order.along(p)))} << 32 |
         ordered_bits(static_cast<float>(p[order.axes[1]]));
}

/// Sorts digit by digit, from the last one; skips digits that all keys share.
void radix_sort(std::vector<Key>& keys) {
  constexpr unsigned k_digit_bits = 11;
  constexpr std::size_t k_values = std::size_t{1} << k_digit_bits;
  std::uint64_t all_or = 0;
  std::uint64_t all_and = ~std::uint64_t{0};
  for (const Key& k : keys) {
    all_or |= k.key;
    all_and &= k.key;
  }
  const std::uint64_t varying = all_or ^ all_and;
  std::vector<Key> other(keys.size());
  std::vector<std::uint32_t> starts;
  for (unsigned shift = 0; shift < 64; shift += k_digit_bits) {
    if ((varying >> shift & (k_values - 1)) == 0) continue;
    starts.assign(k_values + 1, 0);
    for (const Key& k : keys) ++starts[(k.key >> shift & (k_values - 1)) + 1];
    for (std::size_t i = 1; i <= k_values; ++i) starts[i] += starts[i - 1];
    for (const Key& k : keys) other[starts[k.key >> shift & (k_values - 1)]++] = k;
    std::swap(keys, other);
  }
}

}  // namespace

std::vector<std::uint32_t> sorted_vertices(std::span<const Vec3> positions, const SweepOrder& order,
                                           PositionType type) {
  const auto before = [&](Vec3 a, Vec3 b) { return order.before(a, b); };
  if (std::is_sorted(positions.begin(), positions.end(), before)) return {};
  std::vector<Key> keys(positions.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) keys[i] = {key_of(positions[i], order, type), i};
  radix_sort(keys);
  std::vector<std::uint32_t> sorted;
  sorted.reserve(keys.size());
  for (const Key& k : keys) sorted.push_back(k.index);
  // Sorts positions that the keys could not distinguish; they are already ordered by index.
  for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
    while (last < keys.size() && keys[last].key == keys[first].key) ++last;
    if (last - first == 1) continue;
    std::stable_sort(
        sorted.begin() + static_cast<std::ptrdiff_t>(first),
        sorted.begin() + static_cast<std::ptrdiff_t>(last),
        [&](std::uint32_t a, std::uint32_t b) { return order.before(positions[a], positions[b]); });
  }
  return sorted;
}

}  // namespace meshfarm
