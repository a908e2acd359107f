// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/point_tree.hpp"

#include <algorithm>
#include <array>

#include "geometry/bvh_morton.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_children = 8;
// Seven entries stay on each of at most 11 levels of 2^32 points.
constexpr std::size_t k_stack = 7 * 11 + 1;

}  // namespace

PointTree::PointTree(std::span<SearchingPoint> points, std::span<const std::uint32_t> indices)
    : points_(points) {
  if (indices.empty()) return;
  Box all;
  for (const std::uint32_t i : indices) all.add(points[i].place);
  const Vec3 center = all.lo * 0.5 + all.hi * 0.5;
  const Vec3 size = all.hi - all.lo;
  const double longest = std::max({size.x, size.y, size.z});
  const double scale = longest > 0 ? 1 / longest : 1;
  std::vector<MortonItem> items;
  items.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    items.push_back({morton_code((points[i].place - center) * scale), i});
  }
  sort_along_curve(items, [&](std::uint32_t number) { return points[number].place; });
  order_ = numbers_of(items);
  add_levels();
}

void PointTree::add_levels() {
  std::vector<Node> leaves((order_.size() + k_children - 1) / k_children);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    Node& leaf = leaves[i / k_children];
    leaf.box.add(points_[order_[i]].place);
    leaf.squared_reach = std::max(leaf.squared_reach, points_[order_[i]].known());
  }
  levels_.push_back(std::move(leaves));
  while (levels_.back().size() > 1) {
    const std::vector<Node>& below = levels_.back();
    std::vector<Node> above((below.size() + k_children - 1) / k_children);
    for (std::size_t i = 0; i < below.size(); ++i) {
      Node& node = above[i / k_children];
      node.box.add(below[i].box.lo);
      node.box.add(below[i].box.hi);
      node.squared_reach = std::max(node.squared_reach, below[i].squared_reach);
    }
    levels_.push_back(std::move(above));
  }
}

/// Visits the points of all leaves that may reach into the box, until a visit returns true; returns
/// whether one did.
template <class Visit>
bool PointTree::visit(const Box& box, Visit visit_leaf) const {
  if (levels_.empty()) return false;
  struct Entry {
    std::uint32_t level;
    std::uint32_t node;
  };
  std::array<Entry, k_stack> stack;
  std::size_t size = 0;
  stack[size++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
  while (size > 0) {
    const Entry top = stack[--size];
    const Node& node = levels_[top.level][top.node];
    if (squared_gap(node.box, box) > node.squared_reach) continue;
    const std::size_t first = std::size_t{top.node} * k_children;
    if (top.level == 0) {
      const std::size_t end = std::min(order_.size(), first + k_children);
      for (std::size_t i = first; i < end; ++i) {
        if (visit_leaf(points_[order_[i]])) return true;
      }
      continue;
    }
    const std::size_t end = std::min(levels_[top.level - 1].size(), first + k_children);
    for (std::size_t i = first; i < end; ++i) {
      stack[size++] = {top.level - 1, static_cast<std::uint32_t>(i)};
    }
  }
  return false;
}

bool PointTree::wants(const Box& box) const {
  return visit(box, [&](const SearchingPoint& point) {
    return squared_gap(box, point.place) < point.known();
  });
}

void PointTree::offer(const OfferedTriangle& triangle) {
  visit(triangle.box, [&](SearchingPoint& point) {
    point.offer(triangle);
    return false;
  });
}

void PointTree::offer(const Bvh& triangles, const Box& box) {
  visit(box, [&](SearchingPoint& point) {
    const double known = point.known();
    if (squared_gap(box, point.place) < known)
      point.take(triangles.least_below(point.place, known));
    return false;
  });
}

}  // namespace meshfarm
