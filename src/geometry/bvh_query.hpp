// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/bvh.hpp"

namespace meshfarm {

/// What a search has still to look at.
struct BvhEntry {
  float bound;  // below the squared distance, in the frame
  std::uint32_t child;
  std::uint32_t count;
};

// At most three entries stay behind on each level, and a level takes at least one of 63 bits of
// code or halves the 2^32 triangles of one code.
inline constexpr std::size_t k_bvh_stack = 3 * (63 + 32) + 4;
using BvhStack = std::array<BvhEntry, k_bvh_stack>;

/// A query keeps its point as a tiny float box that surely holds it, so that the distance between
/// boxes is a lower bound in spite of rounding.
struct Bvh::Query {
  Vec3 p;
  float lo[3];
  float hi[3];
  double to_frame;  // from squared distances in the mesh's unit
  Nearest best;
  float limit = std::numeric_limits<float>::max();

  Query(Vec3 point, Vec3 in_frame, double scale) : p(point), to_frame(scale * scale) {
    constexpr double k_far = 1e15;  // nearer is a lower bound too, and its square is a float
    for (int axis = 0; axis < 3; ++axis) {
      const float x = static_cast<float>(std::clamp(in_frame[axis], -k_far, k_far));
      const float rounding = std::fabs(x) * 0x1p-23f + std::numeric_limits<float>::min();
      lo[axis] = x - rounding;
      hi[axis] = x + rounding;
    }
  }
  /// Of the boxes of a node, in the frame: no more than they are.
  void squared_gaps(const Node& node, float (&bounds)[4]) const {
    std::fill(bounds, bounds + 4, 0.0F);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 4; ++k) {
        const float before = node.lo[axis][k] - hi[axis];
        const float after = lo[axis] - node.hi[axis][k];
        float gap = before > after ? before : after;
        gap = gap > 0 ? gap : 0;
        bounds[k] += gap * gap;
      }
    }
  }
  /// Puts the node's boxes within the limit onto the stack; the nearest comes to lie on top.
  void push(const Node& node, BvhStack& stack, std::size_t& size) const {
    alignas(16) float bounds[4];
    squared_gaps(node, bounds);
    const std::size_t base = size;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!(bounds[k] < limit)) continue;
      std::size_t at = size++;
      for (; at > base && stack[at - 1].bound < bounds[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {bounds[k], node.child[k], node.count[k]};
    }
  }
  /// Of a squared distance in the mesh's unit: above what the rounding of a bound can make of it.
  float limit_of(double squared) const {
    const double above = squared * to_frame * (1 + 0x1p-20) + std::numeric_limits<float>::min();
    return static_cast<float>(std::min<double>(above, std::numeric_limits<float>::max()));
  }
  void offer(double squared, std::uint32_t triangle) {
    if (!(squared < best.squared)) return;
    best = {squared, triangle};
    limit = limit_of(squared);
  }
};

}  // namespace meshfarm
