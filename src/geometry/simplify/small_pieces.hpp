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

/// What a closed surface holds: below 0 if it faces inwards.
struct SolidMoments {
  double volume = 0;
  Vec3 center;
  std::array<double, 6> spread{};  // xx, xy, xz, yy, yz, zz about the centre, of a unit of volume
};

/// Triangles by their corners' places.
SolidMoments moments_of(std::span<const std::array<Vec3, 3>> triangles);

/// Corners of the tetrahedron with these moments but for the volume: its edges lie across the
/// principal axes, so that each side faces as a rounded body does there. Nothing if the moments are
/// those of no body, or of one without thickness.
std::optional<std::array<Vec3, 4>> tetrahedron_like(const SolidMoments& moments);

/// A map that gives a body with the moments `from` those `to` but for the volume, and turns
/// nothing: the one that moves it least.
struct AffineMap {
  Vec3 from;
  Vec3 to;
  std::array<std::array<double, 3>, 3> matrix;
  Vec3 operator()(Vec3 p) const;
};
std::optional<AffineMap> map_between(const SolidMoments& from, const SolidMoments& to);

/// Closed pieces, while they lose triangles: what four triangles that are left of one are to be
/// like. As edges collapse they are much thinner than it was, or inside out: half of them then face
/// the other way than what of it is nearest.
class SmallPieces {
 public:
  /// All of a mesh. A piece with a vertex that is flagged as fixed, border or complex is none.
  void find(const Mesh& mesh, std::span<const std::uint8_t> flags);
  /// Of a mesh that edges of have been collapsed: those that have become one at the vertices.
  void find_at(std::span<const std::uint32_t> vertices, const Adjacency& adjacency,
               std::span<const Vec3> positions, std::span<const std::uint8_t> flags);
  bool empty() const { return of_vertex_.empty(); }
  bool has(std::uint32_t vertex) const { return of_vertex_[vertex] != 0; }
  /// Whether it is of a piece that was pinched off with no more than four triangles: no part of the
  /// surface, but what pinching has left over.
  bool is_left_over(std::uint32_t vertex) const {
    return !empty() && left_over_[of_vertex_[vertex]] != 0;
  }
  void clear() { of_vertex_.clear(); }
  /// A new vertex, of no piece as yet.
  void add_vertex() {
    if (!empty()) of_vertex_.push_back(0);
  }
  /// `target`: what vertex each is merged into, itself if none. The others close up.
  void compact(std::span<const std::uint32_t> target);

  /// Where vertices of a piece should be.
  struct Places {
    std::vector<std::uint32_t> vertices;
    std::vector<Vec3> positions;
  };
  /// Those of a piece of four triangles, if one is left at the vertex.
  std::optional<Places> tetrahedron_at(std::uint32_t vertex, const Adjacency& adjacency,
                                       PositionType type) const;
  /// Those of all pieces of few triangles that are left of the mesh.
  std::vector<Places> restored(std::span<const Triangle> triangles, std::span<const Vec3> positions,
                               PositionType type) const;

 private:
  std::optional<Places> placed(std::array<std::uint32_t, 4> vertices, const SolidMoments& moments,
                               PositionType type) const;

  std::vector<std::uint32_t> of_vertex_;  // from 1 on; 0: none
  std::vector<SolidMoments> moments_;     // by that
  std::vector<std::uint8_t> left_over_;   // by that
};

}  // namespace meshfarm
