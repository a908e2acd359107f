// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The boundary side file, kind "BNDY", version 1; the payload of a sealed file:
//   triangles u64 | triangles x (3 x (part u32 | local index u32) | label u32, if all have one |
//   texture coordinates 6 x f32, if all have them)
// The size of a triangle tells what they have.
#include <algorithm>
#include <optional>
#include <utility>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'B', 'N', 'D', 'Y'};
constexpr std::uint32_t k_version = 1;

/// Of a file of so many bytes beside its count; nothing if its triangles are of no known size.
std::optional<ColumnSet> columns_of(std::uint64_t count, std::uint64_t bytes) {
  if (count == 0) return bytes == 0 ? std::optional<ColumnSet>(ColumnSet{}) : std::nullopt;
  if (bytes % count != 0) return std::nullopt;
  for (const ColumnSet set : {ColumnSet{}, {true, false}, {false, true}, {true, true}}) {
    if (bytes / count == sizeof(BoundaryTriangle) + set.bytes()) return set;
  }
  return std::nullopt;
}

/// Reads triangles with their columns.
void get_triangles(ByteReader& in, std::uint64_t count, const ColumnSet& set,
                   std::vector<BoundaryTriangle>& triangles, TriangleColumns& columns) {
  if (!set.any()) {
    triangles = in.get_array<BoundaryTriangle>(count);
    return;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    triangles.push_back(in.get<BoundaryTriangle>());
    get_columns(in, 1, set, columns);
  }
}

}  // namespace

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles) {
  TriangleColumns none;
  return drop_duplicates(triangles, none);
}

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles, TriangleColumns& columns) {
  std::vector<std::pair<BoundaryTriangle, std::size_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    BoundaryTriangle key = triangles[i];
    std::sort(key.begin(), key.end());
    sorted.emplace_back(key, i);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> duplicate(triangles.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) duplicate[sorted[i].second] = true;
  }
  return keep_triangles(triangles, columns, [&](std::size_t i) { return !duplicate[i]; });
}

std::string encode_boundary(const std::vector<BoundaryTriangle>& triangles,
                            const TriangleColumnsView& columns) {
  ByteWriter out;
  out.put(static_cast<std::uint64_t>(triangles.size()));
  if (columns.empty()) {
    out.put_array(std::span<const BoundaryTriangle>(triangles));
    return seal(k_kind, k_version, out.bytes());
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    out.put(triangles[i]);
    put_columns(out, columns.part(i, 1));
  }
  return seal(k_kind, k_version, out.bytes());
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what) {
  TriangleColumns columns;
  return decode_boundary(file, what, columns);
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what,
                                              TriangleColumns& columns) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  columns.clear();
  const auto count = in.get<std::uint64_t>();
  const std::optional<ColumnSet> set = columns_of(count, in.remaining());
  if (!set) in.fail("another size than its count tells");
  std::vector<BoundaryTriangle> triangles;
  get_triangles(in, count, *set, triangles, columns);
  return triangles;
}

void scan_boundary(const Fill& fill, std::string_view what,
                   const std::function<void(std::span<const BoundaryTriangle>,
                                            const TriangleColumnsView&)>& show) {
  constexpr std::uint64_t k_at_once = 4096;
  std::string head(k_seal_head_bytes, '\0');
  fill(head);
  const std::uint64_t size = unseal_head(head, k_kind, k_version, what);
  std::uint64_t count = 0;
  fill({reinterpret_cast<char*>(&count), sizeof count});
  const std::optional<ColumnSet> set =
      size < sizeof count ? std::nullopt : columns_of(count, size - sizeof count);
  if (!set) throw DataError(std::string(what) + ": another size than its count tells");
  std::string bytes;
  std::vector<BoundaryTriangle> triangles;
  TriangleColumns columns;
  for (std::uint64_t left = count; left > 0; left -= triangles.size()) {
    const std::uint64_t some = std::min(k_at_once, left);
    bytes.resize(some * (sizeof(BoundaryTriangle) + set->bytes()));
    fill(bytes);
    ByteReader in(bytes, what);
    triangles.clear();
    columns.clear();
    get_triangles(in, some, *set, triangles, columns);
    show(triangles, columns);
  }
  std::uint64_t sum = 0;
  fill({reinterpret_cast<char*>(&sum), sizeof sum});
}

}  // namespace meshfarm
