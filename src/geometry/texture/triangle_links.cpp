// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/texture/triangle_links.hpp"

#include <algorithm>
#include <tuple>

namespace meshfarm {
namespace {

/// One side of a triangle, kept at the lower of its two vertices.
struct Side {
  std::uint32_t other;  // the higher vertex
  std::uint32_t triangle;
  std::uint8_t side;
  bool is_upwards;  // from the lower vertex to the higher one
};

/// The sides at each lower vertex, in the triangles' order.
struct SideTable {
  std::vector<std::size_t> first;
  std::vector<Side> sides;
};

template <typename Take>
void for_sides(const Mesh& mesh, const Take& take) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t from = corners[k], to = corners[k == 2 ? 0 : k + 1];
      if (from == to) continue;
      take(std::min(from, to),
           Side{std::max(from, to), static_cast<std::uint32_t>(t), k, from < to});
    }
  }
}

SideTable sides_by_vertex(const Mesh& mesh) {
  SideTable table;
  table.first.resize(mesh.positions.size() + 2, 0);
  for_sides(mesh, [&](std::uint32_t low, const Side&) { ++table.first[low + 2]; });
  for (std::size_t v = 2; v < table.first.size(); ++v) table.first[v] += table.first[v - 1];
  table.sides.resize(table.first.back());
  for_sides(mesh, [&](std::uint32_t low, const Side& side) {
    table.sides[table.first[low + 1]++] = side;
  });
  return table;
}

class Linker {
 public:
  Linker(std::span<const Vec3> normals, std::vector<TriangleLinks>& links)
      : normals_(normals), links_(links) {}

  /// All sides of one edge.
  void link_edge(std::span<const Side> sides) {
    if (sides.size() < 2) return;
    if (sides.size() == 2) {
      if (sides[0].is_upwards != sides[1].is_upwards) link(sides[0], sides[1]);
      return;
    }
    if (sides.size() > k_most_compared) return;
    pairs_.clear();
    for (const Side& a : sides) {
      for (const Side& b : sides) {
        if (!a.is_upwards || b.is_upwards || a.triangle == b.triangle) continue;
        pairs_.push_back({dot(normals_[a.triangle], normals_[b.triangle]), &a, &b});
      }
    }
    std::stable_sort(pairs_.begin(), pairs_.end(),
                     [](const Pair& x, const Pair& y) { return x.likeness > y.likeness; });
    for (const Pair& pair : pairs_) {
      if (is_free(*pair.a) && is_free(*pair.b)) link(*pair.a, *pair.b);
    }
  }

 private:
  static constexpr std::size_t k_most_compared = 64;
  struct Pair {
    double likeness;
    const Side* a;
    const Side* b;
  };

  bool is_free(const Side& side) const { return links_[side.triangle][side.side] == k_no_triangle; }
  void link(const Side& a, const Side& b) {
    if (a.triangle == b.triangle) return;
    links_[a.triangle][a.side] = b.triangle;
    links_[b.triangle][b.side] = a.triangle;
  }

  std::span<const Vec3> normals_;
  std::vector<TriangleLinks>& links_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::vector<TriangleLinks> link_triangles(const Mesh& mesh, std::span<const Vec3> normals) {
  std::vector<TriangleLinks> links(mesh.triangles.size(),
                                   {k_no_triangle, k_no_triangle, k_no_triangle});
  SideTable table = sides_by_vertex(mesh);
  Linker linker(normals, links);
  for (std::size_t v = 0; v + 2 < table.first.size(); ++v) {
    const std::span<Side> row(table.sides.data() + table.first[v],
                              table.first[v + 1] - table.first[v]);
    std::sort(row.begin(), row.end(), [](const Side& a, const Side& b) {
      return std::tie(a.other, a.triangle, a.side) < std::tie(b.other, b.triangle, b.side);
    });
    for (std::size_t begin = 0; begin < row.size();) {
      std::size_t end = begin + 1;
      while (end < row.size() && row[end].other == row[begin].other) ++end;
      linker.link_edge(row.subspan(begin, end - begin));
      begin = end;
    }
  }
  return links;
}

}  // namespace meshfarm
