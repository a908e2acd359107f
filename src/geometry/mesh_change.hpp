// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/box_tree.hpp"
#include "geometry/triangle_crossing.hpp"

namespace meshfarm {

/// A proposed change: new places of vertices, new corners of triangles.
struct MeshChange {
  std::vector<std::pair<std::uint32_t, Vec3>> moved;
  std::vector<std::pair<std::uint32_t, Triangle>> rewired;
};

/// A mesh in which small changes are judged by their effect on the triangles concerned, and on
/// crossings. The numbers of triangles and vertices stay the same.
class ChangingMesh {
 public:
  /// The mesh must outlive it, have finite coordinates, and be changed only through it.
  explicit ChangingMesh(Mesh& mesh);

  const Mesh& mesh() const { return mesh_; }
  TriangleCorners corners_of(std::uint32_t triangle) const;
  TriangleCorners corners_after(std::uint32_t triangle, const MeshChange& change) const;
  /// The triangles at a vertex.
  std::span<const std::uint32_t> fan(std::uint32_t vertex) const;
  /// The triangle on the other side of the edge from a to b, if exactly one is there and both have
  /// the same orientation.
  std::optional<std::uint32_t> beside(std::uint32_t a, std::uint32_t b) const;
  /// Whether all edges at the vertex have two triangles.
  bool is_inside(std::uint32_t vertex) const;

  /// The triangles that would change, in order.
  std::vector<std::uint32_t> concerned_by(const MeshChange& change) const;
  /// Applies the change unless more pairs of triangles would cross than before. `concerned` are its
  /// triangles.
  bool apply(const MeshChange& change, std::span<const std::uint32_t> concerned);

 private:
  using Triangles = std::vector<CrossingTriangle>;

  void list_fans();
  void build_boxes();
  void list_others(std::span<const std::uint32_t> concerned, const Triangles& before,
                   const Triangles& after);
  std::size_t pairs_of(const Triangles& some, std::size_t enough) const;
  void rewire(const MeshChange& change);
  void change_fan(std::uint32_t vertex, std::uint32_t triangle);

  Mesh& mesh_;
  std::vector<std::size_t> first_;  // of each vertex in fans_
  std::vector<std::uint32_t> fans_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> changed_fans_;  // of rewired corners
  BoxTree boxes_;
  std::vector<std::uint32_t> slot_of_;      // of each triangle in boxes_
  std::vector<std::uint32_t> triangle_in_;  // each slot
  std::vector<std::uint32_t> touching_;
  Triangles others_;  // near the triangles that are judged
};

}  // namespace meshfarm
