// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Welding closes the seams that scanners and exporters leave. Where surfaces merely touch, it would
// make non-manifold vertices and edges. How to recognise such a vertex and split it: Gueziec,
// Taubin, Lazarus, Horn, "Cutting and Stitching: Converting Sets of Polygons to Manifold Surfaces",
// IEEE Transactions on Visualization and Computer Graphics 2001.
#include <algorithm>
#include <cstddef>
#include <tuple>

#include <meshfarm/geometry/weld.hpp>

#include "geometry/union_find.hpp"

namespace meshfarm {
namespace {

/// A triangle at a welded vertex: the twin that it is at, and its other two vertices.
struct TwinCorner {
  std::uint32_t welded;
  std::uint32_t twin;
  std::uint32_t next;
  std::uint32_t prev;
};

/// The same, by the sheet that the twins belong to.
struct SheetCorner {
  std::uint32_t sheet;
  std::uint32_t next;
  std::uint32_t prev;
};

/// The welded vertices whose twins may be separated: each twin has at least three triangles, the
/// least for a closed fan. In a soup of triangles there are none, and nothing more is checked.
std::vector<std::uint8_t> find_candidates(std::span<const Triangle> triangles,
                                          std::span<const std::uint32_t> open,
                                          const std::vector<std::uint32_t>& first) {
  constexpr std::uint8_t k_enough = 3;
  std::vector<std::uint8_t> count(first.size(), 0);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) count[v] = std::min<std::uint8_t>(k_enough, count[v] + 1);
  }
  for (const std::uint32_t v : open) count[v] = 0;
  std::vector<std::uint8_t> candidate(first.size(), 0);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) candidate[first[v]] = 1;
  }
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (count[v] < k_enough) candidate[first[v]] = 0;
  }
  return candidate;
}

/// Whether the triangles of a sheet, sorted by `next`, go once round: each begins where one ends.
bool is_closed_fan(std::span<const SheetCorner> sheet) {
  const auto less = [](const SheetCorner& c, std::uint32_t v) { return c.next < v; };
  std::size_t at = 0;
  for (std::size_t steps = 1; steps <= sheet.size(); ++steps) {
    const auto found = std::lower_bound(sheet.begin(), sheet.end(), sheet[at].prev, less);
    if (found == sheet.end() || found->next != sheet[at].prev) return false;
    at = static_cast<std::size_t>(found - sheet.begin());
    if (at == 0) return steps == sheet.size();
  }
  return false;
}

bool are_closed_fans(std::vector<SheetCorner>& corners) {
  std::sort(corners.begin(), corners.end(), [](const SheetCorner& a, const SheetCorner& b) {
    return std::tie(a.sheet, a.next) < std::tie(b.sheet, b.next);
  });
  const std::span<const SheetCorner> all(corners);
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].sheet == all[begin].sheet) ++end;
    if (!is_closed_fan(all.subspan(begin, end - begin))) return false;
  }
  return true;
}

bool have_common_triangle(std::vector<SheetCorner>& corners) {
  const auto sides = [](const SheetCorner& c) { return std::tie(c.next, c.prev); };
  std::sort(corners.begin(), corners.end(),
            [&](const auto& a, const auto& b) { return sides(a) < sides(b); });
  return std::adjacent_find(corners.begin(), corners.end(), [&](const auto& a, const auto& b) {
           return sides(a) == sides(b);
         }) != corners.end();
}

enum class Parting : std::uint8_t { none, by_sheet, by_twin };

/// Decides for the triangles at one welded vertex.
class PartingJudge {
 public:
  PartingJudge(const std::vector<std::uint32_t>& first, UnionFind& sheets)
      : first_(first), sheets_(sheets) {}

  Parting judge(std::span<const TwinCorner> corners) {
    list_sheets(corners);
    if (seen_.empty()) return Parting::none;
    if (are_closed_fans(seen_)) {
      if (seen_.front().sheet == seen_.back().sheet) return Parting::none;
      return have_common_triangle(seen_) ? Parting::none : Parting::by_sheet;
    }
    seen_.clear();
    for (const TwinCorner& c : corners) seen_.push_back({c.twin, c.next, c.prev});
    return are_closed_fans(seen_) ? Parting::by_twin : Parting::none;
  }

 private:
  void list_sheets(std::span<const TwinCorner> corners) {
    seen_.clear();
    for (const TwinCorner& c : corners) {
      const std::uint32_t next = first_[c.next];
      const std::uint32_t prev = first_[c.prev];
      const bool degenerate = next == prev || next == c.welded || prev == c.welded;
      if (!degenerate) seen_.push_back({sheets_.find(c.twin), next, prev});
    }
  }

  const std::vector<std::uint32_t>& first_;
  UnionFind& sheets_;
  std::vector<SheetCorner> seen_;
};

std::vector<TwinCorner> list_corners(std::span<const Triangle> triangles,
                                     const std::vector<std::uint8_t>& candidate,
                                     const std::vector<std::uint32_t>& first) {
  std::vector<TwinCorner> corners;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t welded = first[t[i]];
      if (candidate[welded] != 0) corners.push_back({welded, t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
    }
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const TwinCorner& a, const TwinCorner& b) { return a.welded < b.welded; });
  return corners;
}

}  // namespace

void separate_touching(std::span<const Triangle> triangles, std::span<const std::uint32_t> open,
                       WeldResult& welded) {
  if (welded.merged == 0) return;
  std::vector<std::uint32_t>& first = welded.first;
  const std::vector<std::uint8_t> candidate = find_candidates(triangles, open, first);
  if (std::find(candidate.begin(), candidate.end(), 1) == candidate.end()) return;

  const std::vector<TwinCorner> corners = list_corners(triangles, candidate, first);
  UnionFind sheets(first.size());
  for (const TwinCorner& c : corners) {
    if (first[c.next] == c.welded) sheets.join(c.twin, c.next);
    if (first[c.prev] == c.welded) sheets.join(c.twin, c.prev);
  }
  std::vector<Parting> parting(first.size(), Parting::none);
  PartingJudge judge(first, sheets);
  for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
    while (end < corners.size() && corners[end].welded == corners[begin].welded) ++end;
    parting[corners[begin].welded] = judge.judge(std::span(corners).subspan(begin, end - begin));
  }
  welded.merged = 0;
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    const Parting how = parting[first[v]];
    if (how != Parting::none) first[v] = how == Parting::by_twin ? v : sheets.find(v);
    welded.merged += first[v] != v;
  }
}

}  // namespace meshfarm
