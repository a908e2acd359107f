// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/fans.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace meshfarm {

std::uint32_t FanSplitter::root(std::uint32_t corner) {
  while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
  return corner;
}

void FanSplitter::join(std::uint32_t one, std::uint32_t other) {
  const std::uint32_t x = root(one);
  const std::uint32_t y = root(other);
  parent_[std::max(x, y)] = std::min(x, y);
}

std::uint32_t FanSplitter::split(std::span<const Corner> corners) {
  const auto size = static_cast<std::uint32_t>(corners.size());
  parent_.resize(size);
  std::iota(parent_.begin(), parent_.end(), 0U);
  ends_.clear();
  for (std::uint32_t i = 0; i < size; ++i) {
    ends_.push_back({corners[i].next, i, true});
    ends_.push_back({corners[i].prev, i, false});
  }
  std::sort(ends_.begin(), ends_.end(), [](const End& x, const End& y) {
    return std::tie(x.neighbour, x.corner) < std::tie(y.neighbour, y.corner);
  });
  const auto for_edges = [&](const auto& take) {
    for (std::size_t first = 0, last = 0; first < ends_.size(); first = last) {
      while (last < ends_.size() && ends_[last].neighbour == ends_[first].neighbour) ++last;
      take(first, last);
    }
  };
  std::uint32_t borders = 0;
  std::uint32_t complex = 0;
  std::uint32_t turned = 0;  // edges whose two triangles face opposite ways
  for_edges([&](std::size_t first, std::size_t last) {
    if (last - first == 2) {
      join(ends_[first].corner, ends_[first + 1].corner);
      turned += ends_[first].begins == ends_[first + 1].begins ? 1 : 0;
    }
    borders += last - first == 1 ? 1 : 0;
    complex += last - first > 2 ? 1 : 0;
  });
  if (complex > 0) {
    // By now, chains are the triangles joined by edges of two triangles.
    std::vector<std::uint32_t> chain(size);
    for (std::uint32_t i = 0; i < size; ++i) chain[i] = root(i);
    for_edges([&](std::size_t first, std::size_t last) {
      if (last - first < 3) return;
      std::uint32_t together = std::numeric_limits<std::uint32_t>::max();
      for (std::size_t i = first; i < last; ++i) {
        int begins = 0;
        int all = 0;
        for (std::size_t k = first; k < last; ++k) {
          if (chain[ends_[k].corner] != chain[ends_[i].corner]) continue;
          ++all;
          begins += ends_[k].begins ? 1 : 0;
        }
        if (all == 2 && begins == 1) continue;  // closes on itself
        if (together == std::numeric_limits<std::uint32_t>::max()) together = ends_[i].corner;
        join(together, ends_[i].corner);
      }
    });
  }
  turned_ = turned > 0;
  fan_.assign(size, 0);
  std::uint32_t fans = 0;
  for (std::uint32_t i = 0; i < size; ++i) fan_[i] = root(i) == i ? fans++ : fan_[root(i)];
  kind_ = complex + turned > 0 || fans > 1 || borders > 2 ? Kind::complex
          : borders == 0                                  ? Kind::closed
                                                          : Kind::open;
  return fans;
}

}  // namespace meshfarm
