// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/pieces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "render/colours.hpp"

namespace meshfarm {
namespace {

/// Of a place; so that one and the same has one only, zeros have no sign.
std::uint64_t hash_of(const ScreenPoint& p) {
  std::uint64_t hash = 0;
  for (const float x : {p.x, p.y, p.depth}) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32;
  }
  return hash;
}

bool at_one_place(const ScreenPoint& a, const ScreenPoint& b) {
  return a.x == b.x && a.y == b.y && a.depth == b.depth;
}

}  // namespace

Pieces::Pieces(PagedArray<ScreenPoint>& vertices, const ArrayRoom& room)
    : array_(vertices.size(), room), before_(array_) {
  join_at_one_place(vertices, room.memory_bytes);
}

/// As many passes over all vertices as it takes to hold the places of one pass in memory.
void Pieces::join_at_one_place(PagedArray<ScreenPoint>& array, std::uint64_t memory_bytes) {
  constexpr std::uint64_t k_least = std::uint64_t{1} << 16;
  constexpr std::uint64_t k_vertex = UINT32_MAX;  // bits of it; the others are of the hash
  const std::uint64_t count = array.size();
  PagedArray<ScreenPoint>::View vertices(array);
  const std::uint64_t places =
      std::min(std::bit_ceil(2 * count + 1),
               std::max(k_least, std::bit_floor(memory_bytes / sizeof(std::uint64_t) + 1)));
  const std::uint64_t passes = 2 * count / places + 1;
  std::vector<std::uint64_t> table(places);  // one more than a vertex, and its hash; or 0
  for (std::uint64_t pass = 0; pass < passes; ++pass) {
    std::fill(table.begin(), table.end(), 0);
    for (std::uint64_t v = 0; v < count; ++v) {
      const ScreenPoint here = vertices.get(v);
      const std::uint64_t hash = hash_of(here);
      if (std::isnan(here.x) || (hash >> 40) % passes != pass) continue;
      const auto is_here = [&](std::uint64_t other) {
        return (other & ~k_vertex) == (hash & ~k_vertex) &&
               at_one_place(vertices.get((other & k_vertex) - 1), here);
      };
      std::uint64_t at = hash & (places - 1);
      while (table[at] != 0 && !is_here(table[at])) at = (at + 1) & (places - 1);
      if (table[at] == 0) {
        table[at] = (hash & ~k_vertex) | (v + 1);
      } else {
        join((table[at] & k_vertex) - 1, v);
      }
    }
  }
}

void Pieces::join(std::span<const WideTriangle> triangles) {
  for (const WideTriangle& t : triangles) {
    join(t[0], t[1]);
    join(t[0], t[2]);
  }
}

std::uint64_t Pieces::colour(PagedArray<std::uint32_t>& array) {
  PagedArray<std::uint32_t>::View colours(array);
  std::uint64_t pieces = 0;
  for (std::uint64_t v = 0; v < array_.size(); ++v) {
    const std::uint64_t first = first_of(v);
    if (first == v) continue;  // without others it is of no triangle
    std::uint32_t colour = colours.get(first);
    if (colour == 0) {
      colour = packed(colour_of_number(pieces++));
      colours.set(first, colour);
    }
    colours.set(v, colour);
  }
  colours.flush();
  return pieces;
}

std::uint64_t Pieces::first_of(std::uint64_t vertex) {
  std::uint64_t at = vertex;
  while (const std::uint32_t step = before_.get(at)) {
    const std::uint32_t next = before_.get(at - step);
    if (next != 0) before_.set(at, step + next);  // halves the way for those that come after
    at -= step;
  }
  return at;
}

void Pieces::join(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t first_a = first_of(a);
  const std::uint64_t first_b = first_of(b);
  if (first_a == first_b) return;
  const auto [first, second] = std::minmax(first_a, first_b);
  before_.set(second, static_cast<std::uint32_t>(second - first));
}

}  // namespace meshfarm
