// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/bvh_morton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {
namespace {

constexpr int k_axis_bits = 21;
constexpr int k_digit_bits = 9;
constexpr int k_digits = 7;                 // of 9 bits: all 63 of a code
constexpr std::ptrdiff_t k_few_equal = 64;  // with fewer, sorting would not pay off
constexpr std::size_t k_values = std::size_t{1} << k_digit_bits;

/// Puts two zero bits before each of the 21 low bits.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffffU;
  bits = (bits | bits << 16) & 0x001f0000ff0000ffU;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fU;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3U;
  return (bits | bits << 2) & 0x1249249249249249U;
}

std::uint64_t cell(double x) {
  constexpr double k_cells = 1 << k_axis_bits;
  return static_cast<std::uint64_t>(std::clamp((x + 0.5) * k_cells, 0.0, k_cells - 1));
}

std::size_t digit(const MortonItem& item, int index) {
  return (item.code >> (index * k_digit_bits)) & (k_values - 1);
}

bool has_lower_code(const MortonItem& a, const MortonItem& b) {
  return a.code < b.code;
}

/// Stable.
void sort_by_code(std::vector<MortonItem>& items) {
  if (items.size() < k_values) {  // clearing and summing the counts would take longer
    std::stable_sort(items.begin(), items.end(), has_lower_code);
    return;
  }
  std::vector<std::array<std::size_t, k_values>> places(k_digits);
  for (const MortonItem& item : items) {
    for (int d = 0; d < k_digits; ++d) ++places[static_cast<std::size_t>(d)][digit(item, d)];
  }
  std::vector<MortonItem> other(items.size());
  for (int d = 0; d < k_digits; ++d) {
    auto& place = places[static_cast<std::size_t>(d)];
    if (std::find(place.begin(), place.end(), items.size()) != place.end()) continue;  // all alike
    std::size_t sum = 0;
    for (std::size_t& at : place) sum += std::exchange(at, sum);
    for (const MortonItem& item : items) other[place[digit(item, d)]++] = item;
    items.swap(other);
  }
}

void sort_equal(std::span<MortonItem> items, const std::function<Vec3(std::uint32_t)>& place_of);

/// In sorted items: where many have equal codes, these are sorted by finer ones.
void sort_many_equal(std::span<MortonItem> items,
                     const std::function<Vec3(std::uint32_t)>& place_of) {
  for (auto begin = items.begin(); begin != items.end();) {
    const auto end = std::find_if(begin, items.end(), [code = begin->code](const MortonItem& item) {
      return item.code != code;
    });
    if (end - begin > k_few_equal) sort_equal({begin, end}, place_of);
    begin = end;
  }
}

/// Sorts by the curve through their own box. The items keep their code.
void sort_equal(std::span<MortonItem> items, const std::function<Vec3(std::uint32_t)>& place_of) {
  Box box;
  for (const MortonItem& item : items) {
    if (const Vec3 place = place_of(item.number); is_finite(place)) box.add(place);
  }
  if (box.empty()) return;
  const Vec3 size = box.hi - box.lo;
  const double scale = 1 / std::max({size.x, size.y, size.z});
  if (!(scale > 0 && std::isfinite(scale))) return;
  const Vec3 center = box.lo * 0.5 + box.hi * 0.5;
  const std::uint64_t code = items.front().code;
  for (MortonItem& item : items) {
    const Vec3 place = place_of(item.number);
    item.code = is_finite(place) ? morton_code((place - center) * scale) : 0;
  }
  std::stable_sort(items.begin(), items.end(), has_lower_code);
  sort_many_equal(items, place_of);
  for (MortonItem& item : items) item.code = code;
}

}  // namespace

std::uint64_t morton_code(Vec3 p) {
  return spread(cell(p.x)) << 2 | spread(cell(p.y)) << 1 | spread(cell(p.z));
}

void sort_along_curve(std::vector<MortonItem>& items,
                      const std::function<Vec3(std::uint32_t)>& place_of) {
  sort_by_code(items);
  sort_many_equal(items, place_of);
}

std::vector<std::uint32_t> numbers_of(std::span<const MortonItem> items) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(items.size());
  for (const MortonItem& item : items) numbers.push_back(item.number);
  return numbers;
}

}  // namespace meshfarm
