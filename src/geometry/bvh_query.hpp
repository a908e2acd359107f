// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/bvh.hpp"

namespace meshfarm {

// At most three entries per level stay on the stack, and each level consumes at least one of the 63
// code bits or halves the 2^32 triangles of one code.
inline constexpr std::size_t k_bvh_stack = 3 * (63 + 32) + 4;

// The farthest coordinate in the frame: its square still is a float.
inline constexpr double k_bvh_far = 1e15;

/// The nodes that a search has yet to visit, initially the root. Stored as three arrays: a single
/// wide read of what three writes have just stored would stall.
class BvhStack {
 public:
  struct Entry {
    float bound;  // below the squared distance, in the frame
    std::uint32_t child;
    std::uint32_t count;
  };

  BvhStack() { push_if(true, 0, 0, 0); }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  Entry pop() {
    --size_;
    return {bound_[size_], child_[size_], count_[size_]};
  }
  /// Branch-free, because a branch would be unpredictable.
  void push_if(bool wanted, float bound, std::uint32_t child, std::uint32_t count) {
    assert(size_ < k_bvh_stack);
    bound_[size_] = bound;
    child_[size_] = child;
    count_[size_] = count;
    size_ += wanted ? 1 : 0;
  }
  /// Sorts the entries from `base` on so that the nearest is on top.
  void sort_from(std::size_t base) {
    for (std::size_t i = base + 1; i < size_; ++i) {
      const float bound = bound_[i];
      if (!(bound_[i - 1] < bound)) continue;
      const std::uint32_t child = child_[i], count = count_[i];
      std::size_t at = i;
      for (; at > base && bound_[at - 1] < bound; --at) {
        bound_[at] = bound_[at - 1];
        child_[at] = child_[at - 1];
        count_[at] = count_[at - 1];
      }
      bound_[at] = bound;
      child_[at] = child;
      count_[at] = count;
    }
  }

 private:
  std::size_t size_ = 0;
  std::array<float, k_bvh_stack> bound_;
  std::array<std::uint32_t, k_bvh_stack> child_;
  std::array<std::uint32_t, k_bvh_stack> count_;
};

/// A query stores its point as a tiny float box that certainly contains it, so that the distance
/// between boxes is a lower bound despite rounding.
struct Bvh::Query {
  // For a loop over four floats that tests which are above 0, g++ emits branches.
  using Four = float __attribute__((vector_size(16)));

  Vec3 p;
  Vec3 place;  // in the frame
  float lo[3];
  float hi[3];
  double to_frame;  // factor for squared distances in the mesh's unit
  Nearest best;
  float limit = std::numeric_limits<float>::max();

  Query(Vec3 point, Vec3 in_frame, double scale)
      : p(point), place(in_frame), to_frame(scale * scale) {
    const Vec3 near = near_frame(in_frame);
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<float>(near[axis]);
      const float rounding = std::fabs(x) * 0x1p-23f + std::numeric_limits<float>::min();
      lo[axis] = x - rounding;
      hi[axis] = x + rounding;
    }
  }
  static Four four(const float (&values)[4]) {
    Four all;
    std::memcpy(&all, values, sizeof all);
    return all;
  }
  /// Lower bounds of the squared distances to a node's boxes, in the frame.
  void squared_gaps(const Node& node, float (&bounds)[4]) const {
    Four sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Four before = four(node.lo[axis]) - hi[axis];
      const Four after = lo[axis] - four(node.hi[axis]);
      const Four gap = before > after ? before : after;
      const Four outside = gap > 0 ? gap : Four{};
      sum += outside * outside;
    }
    std::memcpy(bounds, &sum, sizeof sum);
  }
  /// The squared distance to the whole box, in the frame; a lower bound if the box reaches out of
  /// the frame.
  double squared_gap_to_all(const Node& root) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double first = *std::min_element(root.lo[axis], root.lo[axis] + 4);
      const double last = *std::max_element(root.hi[axis], root.hi[axis] + 4);
      const double before = first > -k_bvh_far ? first - place[axis] : 0;
      const double after = last < k_bvh_far ? place[axis] - last : 0;
      const double gap = std::max({before, after, 0.0});
      sum += gap * gap;
    }
    return sum;
  }
  /// Whether the point is at least a thousand times as far away as the mesh is wide.
  static bool is_far(double squared_gap) { return squared_gap > 0x1p20; }
  /// Pushes the node's boxes within the limit; the nearest ends up on top.
  void push(const Node& node, BvhStack& stack) const {
    float bounds[4];
    squared_gaps(node, bounds);
    const std::size_t base = stack.size();
    for (std::size_t k = 0; k < 4; ++k) {
      stack.push_if(bounds[k] < limit, bounds[k], node.child[k], node.count[k]);
    }
    stack.sort_from(base);
  }
  /// The limit for a squared distance in the mesh's unit, with a margin for the rounding of bounds.
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
