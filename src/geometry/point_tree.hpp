// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/searching_point.hpp"

namespace meshfarm {

/// A tree over points that search for their nearest triangle, each within the distance known when
/// the tree was built: eight children per node, in Morton order.
class PointTree {
 public:
  /// Contains the points with these indices. `points` must outlive the tree.
  PointTree(std::span<SearchingPoint> points, std::span<const std::uint32_t> indices);

  /// Whether something in the box may be nearer to a point than its known distance.
  bool wants(const Box& box) const;
  /// Offers the triangle to all points that it may be nearest to.
  void offer(const OfferedTriangle& triangle);
  /// Offers many triangles, all in this box, at once.
  void offer(const Bvh& triangles, const Box& box);

 private:
  struct Node {
    Box box;                   // of the points
    double squared_reach = 0;  // the largest search distance of a point
  };

  template <class Visit>
  bool visit(const Box& box, Visit visit_leaf) const;
  void add_levels();

  std::span<SearchingPoint> points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Node>> levels_;  // leaves first, one node last
};

}  // namespace meshfarm
