// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <span>

#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_leaf = 6;
constexpr std::uint64_t k_chunk = 4096;
// An axis gets less weight along the curve only if triangles are this many times as long along it.
constexpr double k_much_longer = 4;
constexpr float k_huge = std::numeric_limits<float>::max();
// At least this many triangles (or all) are sampled, by one corner each, to find where most of the
// mesh is.
constexpr std::size_t k_asked = 4096;
// Most of the mesh is what lies between these shares along an axis. Points farther away from it
// than this multiple of its extent may lie outside the frame.
constexpr double k_outermost = 1.0 / 16;
constexpr double k_far_from_most = 64;

float below(double x) {
  return std::nextafter(static_cast<float>(x), -k_huge);
}
float above(double x) {
  return std::nextafter(static_cast<float>(x), k_huge);
}

double longest_side(Vec3 size) {
  return std::max({size.x, size.y, size.z});
}

/// `all` without what is far from nearly everything else. With one vertex a hundred million times
/// as far away as the mesh is wide, floats could not tell the others apart.
Box without_outliers(const Box& all, std::span<const Vec3> positions,
                     std::span<const Triangle> triangles) {
  const std::size_t step = std::max<std::size_t>(1, triangles.size() / k_asked);
  Box most;
  const std::array axes = {&Vec3::x, &Vec3::y, &Vec3::z};
  for (double Vec3::*const axis : axes) {
    std::vector<double> asked;
    for (std::size_t t = 0; t < triangles.size(); t += step) {
      asked.push_back(positions[triangles[t][0]].*axis);
    }
    const auto few = static_cast<std::ptrdiff_t>(k_outermost * static_cast<double>(asked.size()));
    std::nth_element(asked.begin(), asked.begin() + few, asked.end());
    most.lo.*axis = asked[static_cast<std::size_t>(few)];
    std::nth_element(asked.begin(), asked.end() - 1 - few, asked.end());
    most.hi.*axis = *(asked.end() - 1 - few);
  }
  const double margin = k_far_from_most * longest_side(most.hi - most.lo);
  if (!(margin > 0 && std::isfinite(margin))) return all;
  for (double Vec3::*const axis : axes) {
    most.lo.*axis = std::max(all.lo.*axis, most.lo.*axis - margin);
    most.hi.*axis = std::min(all.hi.*axis, most.hi.*axis + margin);
  }
  return most;
}

struct Range {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t size() const { return end - begin; }
};

/// The position where the highest differing bit of the range's codes turns to 1; the middle if all
/// codes are equal.
std::uint32_t split_of(std::span<const MortonItem> items, Range range) {
  const std::uint64_t differing = items[range.begin].code ^ items[range.end - 1].code;
  if (differing == 0) return range.begin + range.size() / 2;
  const std::uint64_t bit = std::bit_floor(differing);
  const auto found =
      std::partition_point(items.begin() + range.begin, items.begin() + range.end,
                           [bit](const MortonItem& item) { return (item.code & bit) == 0; });
  return static_cast<std::uint32_t>(found - items.begin());
}

struct Split {
  std::array<Range, 4> parts;
  std::size_t count = 0;
};

/// Repeatedly splits the largest part in two, until there are four or all are leaves.
Split split_in_four(std::span<const MortonItem> items, Range range) {
  Split split{{range}, 1};
  while (split.count < 4) {
    const auto largest = std::max_element(
        split.parts.begin(), split.parts.begin() + static_cast<std::ptrdiff_t>(split.count),
        [](const Range& a, const Range& b) { return a.size() < b.size(); });
    if (largest->size() <= k_leaf) break;
    const std::uint32_t at = split_of(items, *largest);
    split.parts[split.count++] = {at, largest->end};
    largest->end = at;
  }
  return split;
}

}  // namespace

Bvh::Bvh(const Mesh& mesh, unsigned threads) : Bvh(mesh.positions, mesh.triangles, threads) {}

Bvh::Bvh(std::span<const Vec3> positions, std::span<const Triangle> triangles, unsigned threads)
    : positions_(positions), triangles_(triangles) {
  assert(!triangles.empty());
  set_frame_and_curve();
  make_nodes(threads);
}

/// Where triangles are long along one axis, boxes become as thin across it as the triangles.
void Bvh::set_frame_and_curve() {
  Box all;
  Vec3 sum;  // of the triangles' boxes, scaled: large triangles count no more than small ones
  for (const Triangle& t : triangles_) {
    Box box;
    for (const std::uint32_t v : t) {
      box.add(positions_[v]);
      all.add(positions_[v]);
    }
    const Vec3 size = box.hi - box.lo;
    const double longest = longest_side(size);
    if (longest > 0) sum = sum + size * (1 / longest);
  }
  const Box box = without_outliers(all, positions_, triangles_);
  center_ = box.lo * 0.5 + box.hi * 0.5;
  const double longest = longest_side(box.hi - box.lo);
  if (longest > 0) scale_ = std::ldexp(1.0, -std::ilogb(longest) - 1);
  const double middle = std::max(std::min(sum.x, sum.y), std::min(std::max(sum.x, sum.y), sum.z));
  if (!(middle > 0)) return;
  const auto share = [middle](double length) {
    return length > k_much_longer * middle ? middle / length : 1.0;
  };
  along_curve_ = {share(sum.x), share(sum.y), share(sum.z)};
}

Vec3 Bvh::to_curve(Vec3 in_frame) const {
  return {in_frame.x * along_curve_.x, in_frame.y * along_curve_.y, in_frame.z * along_curve_.z};
}

void Bvh::make_nodes(unsigned threads) {
  {
    const std::vector<MortonItem> items = sorted_items(threads);
    split_into_nodes(items);
    order_ = numbers_of(items);
  }
  parallel_for((nodes_.size() + k_chunk - 1) / k_chunk, threads, [&](std::uint64_t chunk) {
    const std::size_t end = std::min<std::size_t>(nodes_.size(), (chunk + 1) * k_chunk);
    for (std::size_t i = chunk * k_chunk; i < end; ++i) set_leaf_boxes(nodes_[i]);
  });
  // Children come after their parents.
  for (std::size_t i = nodes_.size(); i-- > 0;) set_inner_boxes(nodes_[i]);
}

Vec3 Bvh::middle_of(std::uint32_t triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  return (to_frame(positions_[a]) + to_frame(positions_[b]) + to_frame(positions_[c])) * (1.0 / 3);
}

std::vector<MortonItem> Bvh::sorted_items(unsigned threads) const {
  std::vector<MortonItem> items(triangles_.size());
  parallel_for((items.size() + k_chunk - 1) / k_chunk, threads, [&](std::uint64_t chunk) {
    const std::size_t end = std::min<std::size_t>(items.size(), (chunk + 1) * k_chunk);
    for (std::size_t i = chunk * k_chunk; i < end; ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      items[i] = {morton_code(to_curve(middle_of(number))), number};
    }
  });
  sort_along_curve(items, [&](std::uint32_t number) { return to_curve(middle_of(number)); });
  return items;
}

void Bvh::split_into_nodes(std::span<const MortonItem> items) {
  struct Open {
    Range range;
    std::uint32_t node;
  };
  std::vector<Open> open{{{0, static_cast<std::uint32_t>(items.size())}, 0}};
  nodes_.reserve(items.size() / 8 + 1);  // usual; what is not used is never touched
  nodes_.emplace_back();
  while (!open.empty()) {
    const Open top = open.back();
    open.pop_back();
    const Split split = split_in_four(items, top.range);
    for (std::size_t k = 0; k < 4; ++k) {
      const Range part = k < split.count ? split.parts[k] : Range{};
      const bool is_leaf = part.size() <= k_leaf;
      const auto next = static_cast<std::uint32_t>(nodes_.size());
      nodes_[top.node].child[k] = is_leaf ? part.begin : next;
      nodes_[top.node].count[k] = is_leaf ? part.size() : 0;
      if (is_leaf) continue;
      open.push_back({part, next});
      nodes_.emplace_back();
    }
  }
}

void Bvh::set_leaf_boxes(Node& node) const {
  for (std::size_t k = 0; k < 4; ++k) {
    Box box;
    for (std::uint32_t i = 0; i < node.count[k]; ++i) {
      for (const std::uint32_t v : triangles_[order_[node.child[k] + i]]) {
        box.add(near_frame(to_frame(positions_[v])));
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      node.lo[axis][k] = box.empty() ? k_huge : below(box.lo[axis]);
      node.hi[axis][k] = box.empty() ? -k_huge : above(box.hi[axis]);
    }
  }
}

void Bvh::set_inner_boxes(Node& node) const {
  for (std::size_t k = 0; k < 4; ++k) {
    if (node.count[k] > 0 || node.child[k] == 0) continue;
    const Node& child = nodes_[node.child[k]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.lo[axis][k] = *std::min_element(child.lo[axis], child.lo[axis] + 4);
      node.hi[axis][k] = *std::max_element(child.hi[axis], child.hi[axis] + 4);
    }
  }
}

}  // namespace meshfarm
