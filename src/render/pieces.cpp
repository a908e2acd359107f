// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/pieces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <meshfarm/util/bucket_file.hpp>

#include "render/colours.hpp"

namespace meshfarm {
namespace {

/// Hash of a position; signs of zeros are removed, so that equal positions have equal hashes.
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

Pieces::Pieces(PagedArray<ScreenPoint>& vertices, const ArrayRoom& room,
               std::uint64_t memory_for_places)
    : array_(vertices.size(), room), before_(array_) {
  join_at_one_place(vertices, {room.folder, memory_for_places});
}

/// Vertices at the same position are in the same bucket, and a bucket is small enough for a cache.
void Pieces::join_at_one_place(PagedArray<ScreenPoint>& array, const ArrayRoom& room) {
  constexpr std::uint64_t k_in_a_bucket = std::uint64_t{1} << 15;
  constexpr std::uint64_t k_most_buckets = std::uint64_t{1} << 13;
  const std::uint64_t count = array.size();
  const std::uint64_t buckets = std::min(k_most_buckets, count / k_in_a_bucket + 1);
  PagedArray<ScreenPoint>::View vertices(array);
  BucketFile places(room.folder, buckets, room.memory_bytes);
  for (std::uint64_t v = 0; v < count; ++v) {
    const ScreenPoint here = vertices.get(v);
    if (std::isnan(here.x)) continue;
    places.put((hash_of(here) & UINT32_MAX) * buckets >> 32,
               PlacedVertex{here, static_cast<std::uint32_t>(v)});
  }
  places.finish();
  std::vector<std::uint32_t> table;
  for (std::uint64_t bucket = 0; bucket < buckets; ++bucket) {
    join_at_one_place(places.read<PlacedVertex>(bucket), table);
  }
}

void Pieces::join_at_one_place(const std::vector<PlacedVertex>& vertices,
                               std::vector<std::uint32_t>& table) {
  const std::uint64_t mask = std::bit_ceil(2 * vertices.size() + 1) - 1;
  table.assign(mask + 1, 0);  // an index plus one, or 0
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    std::uint64_t at = (hash_of(vertices[i].place) >> 32) & mask;
    while (table[at] != 0 && !at_one_place(vertices[table[at] - 1].place, vertices[i].place)) {
      at = (at + 1) & mask;
    }
    if (table[at] == 0) {
      table[at] = i + 1;
    } else {
      join(vertices[table[at] - 1].vertex, vertices[i].vertex);
    }
  }
}

void Pieces::join(std::span<const WideTriangle> triangles) {
  for (const WideTriangle& t : triangles) {
    const std::uint64_t first = join_firsts(first_of(t[0]), first_of(t[1]));
    join_firsts(first, first_of(t[2]));
  }
}

std::uint64_t Pieces::colour(PagedArray<std::uint32_t>& array) {
  PagedArray<std::uint32_t>::View colours(array);
  std::uint64_t pieces = 0;
  for (std::uint64_t v = 0; v < array_.size(); ++v) {
    const std::uint64_t first = first_of(v);
    if (first == v) continue;  // if it is alone, it is in no triangle
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
    if (next != 0) before_.set(at, step + next);  // path halving for later look-ups
    at -= step;
  }
  return at;
}

void Pieces::join(std::uint64_t a, std::uint64_t b) {
  join_firsts(first_of(a), first_of(b));
}

/// Joins both pieces and returns the first vertex.
std::uint64_t Pieces::join_firsts(std::uint64_t a, std::uint64_t b) {
  if (a == b) return a;
  const auto [first, second] = std::minmax(a, b);
  before_.set(second, static_cast<std::uint32_t>(second - first));
  return first;
}

}  // namespace meshfarm
