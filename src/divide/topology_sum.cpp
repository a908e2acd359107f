// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/topology_sum.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace meshfarm {
namespace {

/// The number of a boundary vertex.
std::uint32_t number_of(const BoundaryNumbers& numbers, std::uint32_t place) {
  const auto at = std::lower_bound(numbers.places.begin(), numbers.places.end(), place);
  return numbers.numbers[static_cast<std::size_t>(at - numbers.places.begin())];
}

/// The sides of triangles between slabs that lie within one slab, in vertices of its mesh.
std::vector<std::array<std::uint32_t, 2>> sides_within(std::uint32_t slab,
                                                       std::span<const SeamTriangle> seam,
                                                       std::span<const std::uint32_t> shared,
                                                       const BoundaryNumbers& numbers) {
  std::vector<std::array<std::uint32_t, 2>> sides;
  for (const SeamTriangle& t : seam) {
    for (std::size_t k = 0; k < 3; ++k) {
      const SharePlace a = t[k];
      const SharePlace b = t[(k + 1) % 3];
      if (a.share != slab || b.share != slab) continue;
      const std::uint32_t from = number_of(numbers, a.place);
      const std::uint32_t to = number_of(numbers, b.place);
      if (from != to) sides.push_back({shared[from], shared[to]});
    }
  }
  return sides;
}

}  // namespace

void TopologySum::add(std::uint32_t slab, const MeasuredSlab& measured,
                      const BoundaryNumbers& numbers) {
  const std::vector<std::uint32_t>& shared = measured.shared;
  const PieceTopology piece =
      measure_piece(measured.mesh, sides_within(slab, shares_.seam(slab), shared, numbers), shared);
  std::vector<std::uint32_t> roots = piece.roots;
  std::sort(roots.begin(), roots.end());
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  std::vector<SharedVertex> vertices;
  vertices.reserve(numbers.places.size());
  for (std::size_t i = 0; i < numbers.places.size(); ++i) {
    const std::uint32_t number = numbers.numbers[i];
    const auto root = std::lower_bound(roots.begin(), roots.end(), piece.roots[number]);
    vertices.push_back({numbers.places[i], number, static_cast<std::uint32_t>(root - roots.begin()),
                        measured.mesh.positions[shared[number]]});
  }
  vertices_.add(slab, vertices);
  const std::lock_guard lock(mutex_);
  pieces_[slab] = roots.size();
  add(piece.topology);
}

void TopologySum::add(const Topology& piece) {
  sum_.used_vertices += piece.used_vertices;
  sum_.triangles += piece.triangles;
  sum_.degenerate += piece.degenerate;
  sum_.zero_area += piece.zero_area;
  sum_.duplicate += piece.duplicate;
  sum_.edges += piece.edges;
  sum_.border_edges += piece.border_edges;
  sum_.nonmanifold_edges += piece.nonmanifold_edges;
  sum_.orientation_conflicts += piece.orientation_conflicts;
  sum_.unmatched_edges += piece.unmatched_edges;
  sum_.components += piece.components;
}

Topology TopologySum::finish() {
  vertices_.finish();
  parent_.resize(std::accumulate(pieces_.begin(), pieces_.end(), std::uint64_t{0}));
  std::iota(parent_.begin(), parent_.end(), std::uint64_t{0});
  std::exclusive_scan(pieces_.begin(), pieces_.end(), pieces_.begin(), std::uint64_t{0});
  for (std::uint32_t slab = 0; slab < pieces_.size(); ++slab) add_seam(slab);
  sum_.euler =
      static_cast<std::int64_t>(sum_.used_vertices - sum_.edges + sum_.triangles - sum_.degenerate);
  return sum_;
}

void TopologySum::add_seam(std::uint32_t slab) {
  vertices_.forget_below(slab);
  between_.clear();
  crossing_.clear();
  for (const SeamTriangle& t : shares_.seam(slab)) {
    if (std::min({t[0].share, t[1].share, t[2].share}) == slab) add_between(t);
    add_sides(slab, t);
  }
  count_sides();
  sum_.duplicate += drop_duplicates(between_);
}

/// Adds a triangle that belongs to the current slab.
void TopologySum::add_between(const SeamTriangle& t) {
  ++sum_.triangles;
  const BoundaryTriangle corners = {corner(t[0]), corner(t[1]), corner(t[2])};
  if (is_degenerate(corners)) {
    ++sum_.degenerate;
    return;
  }
  const Vec3 a = vertices_.at(t[0]).position;
  const Vec3 b = vertices_.at(t[1]).position;
  const Vec3 c = vertices_.at(t[2]).position;
  sum_.zero_area += cross(b - a, c - a) == Vec3{} ? 1 : 0;
  join(t);
  between_.push_back(corners);
}

/// Adds the sides that belong to this slab, also of triangles that belong to a lower one.
void TopologySum::add_sides(std::uint32_t slab, const SeamTriangle& t) {
  std::array<bool, 3> is_ours{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = t[k].share;
    const std::uint32_t b = t[(k + 1) % 3].share;
    is_ours[k] = a != b && std::min(a, b) == slab;
  }
  // If two corners are in one slab, their sides to the third corner belong to the same slab. Only
  // then can the two corners be one vertex, which makes the triangle degenerate.
  if (std::count(is_ours.begin(), is_ours.end(), true) == 2) {
    for (std::size_t k = 0; k < 3; ++k) {
      const SharePlace a = t[k];
      const SharePlace b = t[(k + 1) % 3];
      if (a.share == b.share && corner(a) == corner(b)) return;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_ours[k]) crossing_.push_back({corner(t[k]), corner(t[(k + 1) % 3])});
  }
}

void TopologySum::count_sides() {
  const auto ordered = [](const SideEnds& side) {
    return std::pair(std::min(side[0], side[1]), std::max(side[0], side[1]));
  };
  std::sort(crossing_.begin(), crossing_.end(), [&](const SideEnds& x, const SideEnds& y) {
    return ordered(x) != ordered(y) ? ordered(x) < ordered(y) : x < y;
  });
  for (std::size_t first = 0, last = 0; first < crossing_.size(); first = last) {
    std::size_t up = 0;
    for (; last < crossing_.size() && ordered(crossing_[last]) == ordered(crossing_[first]);
         ++last) {
      up += crossing_[last][0] < crossing_[last][1] ? 1 : 0;
    }
    const std::size_t down = last - first - up;
    ++sum_.edges;
    sum_.border_edges += up + down == 1;
    sum_.nonmanifold_edges += up + down > 2;
    sum_.unmatched_edges += up != down;
    sum_.orientation_conflicts += (up > 1 ? up - 1 : 0) + (down > 1 ? down - 1 : 0);
  }
}

/// Joins the pieces at the triangle's corners.
void TopologySum::join(const SeamTriangle& t) {
  for (std::size_t k = 1; k < 3; ++k) {
    const std::uint64_t a = piece_of(t[0]);
    const std::uint64_t b = piece_of(t[k]);
    if (a == b) continue;
    parent_[std::max(a, b)] = std::min(a, b);
    --sum_.components;
  }
}

std::uint64_t TopologySum::piece_of(SharePlace vertex) {
  std::uint64_t i = pieces_[vertex.share] + vertices_.at(vertex).piece;
  while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
  return i;
}

BoundaryCorner TopologySum::corner(SharePlace vertex) {
  return {vertex.share, vertices_.at(vertex).number};
}

}  // namespace meshfarm
