// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace meshfarm {

/// Disjoint sets of vertices; each set is represented by its lowest vertex.
class UnionFind {
 public:
  explicit UnionFind(std::size_t vertices) : parent_(vertices) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  /// True if they were in different sets.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }
  std::uint32_t find(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace meshfarm
