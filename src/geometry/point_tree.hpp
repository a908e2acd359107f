// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/searching_point.hpp"

namespace meshfarm {

/// A tree over points that look for the nearest triangle, each no farther than it had found one
/// when the tree was made: eight of the next level a node, in Morton order.
class PointTree {
 public:
  /// Of the points with these indices. `points` must outlive the tree.
  PointTree(std::span<SearchingPoint> points, std::span<const std::uint32_t> indices);

  /// Whether something in the box may be nearer to a point than what it knows.
  bool wants(const Box& box) const;
  /// Offers the triangle to all points that it may be the nearest to.
  void offer(const OfferedTriangle& triangle);
  /// Offers many triangles, in this box, at once.
  void offer(const Bvh& triangles, const Box& box);

 private:
  struct Node {
    Box box;                   // of the points
    double squared_reach = 0;  // how far one of them looks at most
  };

  template <class Visit>
  bool visit(const Box& box, Visit visit_leaf) const;
  void add_levels();

  std::span<SearchingPoint> points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Node>> levels_;  // leaves first, one node last
};

}  // namespace meshfarm
