// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/union_find.hpp"

namespace meshfarm {

/// The triangles of a mesh in sets that are joined across edges of two triangles.
class PieceSets {
 public:
  /// A piece of more triangles is not small. Larger ones are not left with four.
  static constexpr std::size_t k_most = 1'024;

  /// `flags` (VertexFlag) tell which vertices are complex, fixed or on a border.
  PieceSets(const Mesh& mesh, std::span<const std::uint8_t> flags);

  std::size_t nodes() const { return sizes_.size(); }
  /// The set, by its lowest node.
  std::uint32_t of_triangle(std::size_t triangle) { return sets_.find(first_[triangle]); }
  /// The vertex must not be complex.
  std::uint32_t of_vertex(std::uint32_t vertex) { return sets_.find(vertex); }
  /// Whether it is closed by itself, and has few triangles, but more than four.
  bool is_small(std::uint32_t set) const { return sizes_[set] > 4 && sizes_[set] <= k_most; }
  /// Whether a vertex of it is complex.
  bool touches(std::uint32_t set) const { return touches_[set] != 0; }

 private:
  struct Edge {
    std::uint64_t ends;
    std::uint32_t triangle;
  };

  bool is_complex(std::uint32_t v) const;
  std::size_t give_nodes();
  void list_edges();
  void join();
  void measure();
  void drop_open();
  template <typename Take>
  void for_edges(const Take& take) const;

  const Mesh& mesh_;
  std::span<const std::uint8_t> flags_;
  std::vector<std::uint32_t> first_;  // of each triangle: its node
  std::vector<std::uint32_t> sizes_;  // by the node that stands for a set; 0: it is open
  std::vector<std::uint8_t> touches_;
  UnionFind sets_;
  std::vector<Edge> edges_;  // between complex vertices
};

/// Gives small closed pieces that touch others vertices of their own. Returns whether there are
/// any.
bool separate_small_pieces(Mesh& mesh, std::span<const std::uint8_t> flags);

}  // namespace meshfarm
