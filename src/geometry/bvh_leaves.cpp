// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "geometry/bvh_query.hpp"

namespace meshfarm {

Bvh::Leaf Bvh::leaf_of(const Node& node, std::size_t k) {
  Leaf leaf{node.child[k], node.count[k], {}, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    leaf.lo[axis] = node.lo[axis][k];
    leaf.hi[axis] = node.hi[axis][k];
  }
  return leaf;
}

std::vector<Bvh::Leaf> Bvh::leaves() const {
  std::vector<Leaf> leaves;
  for (const Node& node : nodes_) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (node.count[k] > 0) leaves.push_back(leaf_of(node, k));
    }
  }
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf& a, const Leaf& b) { return a.first < b.first; });
  return leaves;
}

void Bvh::find_touching(const Leaf& leaf, std::vector<Leaf>& found) const {
  std::array<std::uint32_t, k_bvh_stack> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    // The distance between the boxes along the axis where it is largest; empty boxes are far away.
    float gaps[4] = {-1, -1, -1, -1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 4; ++k) {
        const float before = node.lo[axis][k] - leaf.hi[axis];
        const float after = leaf.lo[axis] - node.hi[axis][k];
        const float gap = before > after ? before : after;
        gaps[k] = gap > gaps[k] ? gap : gaps[k];
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (gaps[k] > 0) continue;
      if (node.count[k] == 0) {
        stack[size++] = node.child[k];
      } else if (node.child[k] >= leaf.first) {
        found.push_back(leaf_of(node, k));
      }
    }
  }
}

}  // namespace meshfarm
