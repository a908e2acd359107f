// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/weld_share.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace meshfarm {
namespace {

std::uint64_t count_coincident(std::span<const Triangle> triangles,
                               std::span<const std::uint32_t> first) {
  return static_cast<std::uint64_t>(
      std::count_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
        const std::uint32_t a = first[t[0]];
        const std::uint32_t b = first[t[1]];
        const std::uint32_t c = first[t[2]];
        return a == b || b == c || c == a;
      }));
}

void keep_sheets(std::span<const ApartVertex> apart, std::span<std::uint32_t> first) {
  constexpr std::uint32_t k_none = UINT32_MAX;
  std::vector<std::uint32_t> first_of_sheet(apart.size(), k_none);
  for (const auto& [place, sheet] : apart) {
    if (first_of_sheet[sheet] == k_none) first_of_sheet[sheet] = place;
    first[place] = first_of_sheet[sheet];
  }
}

}  // namespace

WeldCounts keep_apart(const MeshShare& share, WeldResult& welded) {
  if (welded.merged == 0) return {};
  WeldCounts counts;
  counts.coincident_vertices = welded.merged;
  counts.coincident_corners = count_coincident(share.triangles, welded.first);
  separate_touching(share.triangles, share.boundary, welded);
  keep_sheets(share.apart, welded.first);
  return counts;
}

}  // namespace meshfarm
