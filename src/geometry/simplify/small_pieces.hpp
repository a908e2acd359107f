// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/adjacency.hpp"

namespace meshfarm {

/// Moments of the inside of a closed surface; the volume is below 0 if it faces inwards.
struct SolidMoments {
  double volume = 0;
  Vec3 center;
  std::array<double, 6> spread{};  // xx, xy, xz, yy, yz, zz about the centre, per volume
};

/// Of triangles given by the positions of their corners.
SolidMoments moments_of(std::span<const std::array<Vec3, 3>> triangles);

/// Corners of the tetrahedron with these moments, except for the volume. Its edges lie across the
/// principal axes, so that each side faces as a rounded body does there. Nothing if no body has
/// these moments, or only one without thickness.
std::optional<std::array<Vec3, 4>> tetrahedron_like(const SolidMoments& moments);

/// The map from a body with the moments `from` to one with the moments `to`, except for the volume,
/// without rotation: the one that moves it least.
struct AffineMap {
  Vec3 from;
  Vec3 to;
  std::array<std::array<double, 3>, 3> matrix;
  Vec3 operator()(Vec3 p) const;
};
std::optional<AffineMap> map_between(const SolidMoments& from, const SolidMoments& to);

/// Closed pieces, while they lose triangles: remembers the shape to give to the last four triangles
/// of each. As edges collapse, these become much thinner than the piece was, or inside out: half of
/// them then face away from what is nearest on the piece.
class SmallPieces {
 public:
  /// Finds all pieces of a mesh. A piece with a vertex flagged as fixed, border or complex does not
  /// count.
  void find(const Mesh& mesh, std::span<const std::uint8_t> flags);
  /// In a mesh whose edges have been collapsed: finds the pieces that have formed at the vertices.
  void find_at(std::span<const std::uint32_t> vertices, const Adjacency& adjacency,
               std::span<const Vec3> positions, std::span<const std::uint8_t> flags);
  bool empty() const { return of_vertex_.empty(); }
  bool has(std::uint32_t vertex) const { return of_vertex_[vertex] != 0; }
  /// Whether the vertex is of a piece that was pinched off with at most four triangles: not a part
  /// of the surface, but a leftover of pinching.
  bool is_left_over(std::uint32_t vertex) const {
    return !empty() && left_over_[of_vertex_[vertex]] != 0;
  }
  void clear() { of_vertex_.clear(); }
  /// Adds a vertex that belongs to no piece yet.
  void add_vertex() {
    if (!empty()) of_vertex_.push_back(0);
  }
  /// `target`: the vertex that each is merged into, itself if none. Merged vertices are dropped.
  void compact(std::span<const std::uint32_t> target);

  /// Where vertices of a piece should be.
  struct Places {
    std::vector<std::uint32_t> vertices;
    std::vector<Vec3> positions;
  };
  /// The places for the piece at the vertex, if four triangles are left of it.
  std::optional<Places> tetrahedron_at(std::uint32_t vertex, const Adjacency& adjacency,
                                       PositionType type) const;
  /// The places for all pieces of the mesh that have few triangles left.
  std::vector<Places> restored(std::span<const Triangle> triangles, std::span<const Vec3> positions,
                               PositionType type) const;

 private:
  std::optional<Places> placed(std::array<std::uint32_t, 4> vertices, const SolidMoments& moments,
                               PositionType type) const;

  std::vector<std::uint32_t> of_vertex_;  // piece of each vertex, from 1; 0: none
  std::vector<SolidMoments> moments_;     // by piece
  std::vector<std::uint8_t> left_over_;   // by piece
};

}  // namespace meshfarm
