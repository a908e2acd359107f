// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// Simplification checks only points. If the whole surface turns out to exceed the bound by this
/// factor somewhere, everything near there stays unchanged, and simplification begins again; at
/// most k_bounded_tries times in all, and the last result is not checked. Parts and seams are given
/// shares of the run's bound (k_bound_share_of_parts, k_bound_share); times its share, each factor
/// is about 1.08 of the run's bound.
inline constexpr double k_most_beyond_of_part = 1.2;
inline constexpr double k_most_beyond_of_seam = 1.17;
inline constexpr int k_bounded_tries = 6;

/// How far around an astray piece the input stays unchanged, in multiples of the bound: the piece
/// is more than one bound away from all of it. Grows with each try.
constexpr double reach_of_astray(int tries) {
  return 1.2 + 0.2 * tries;
}

/// A triangle by its positions, in sorted order: vertices may be taken apart, or renumbered.
using TrianglePlaces = std::array<std::array<double, 3>, 3>;
TrianglePlaces places_of(const Mesh& mesh, const Triangle& t);

/// The triangles of a surface with non-zero area that are not proven to be within the distance of
/// another surface, which must not be empty (find_beyond).
Mesh part_beyond(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads);

/// Finds what of a result is too far from a surface. Triangles found near once are not checked
/// again: most of a result that was made again is unchanged.
class AstrayFinder {
 public:
  /// The surface must not be empty, and must outlive it.
  AstrayFinder(const TriangleIndex& surface, double distance, unsigned threads);

  /// Skips these triangles in later checks, wherever they are.
  void pass_over(const Mesh& known);
  /// Triangles with non-zero area that are not proven to be near; for large ones only the pieces
  /// that are not.
  Mesh find(const Mesh& result);

 private:
  Mesh far_pieces(const Mesh& beyond) const;

  const TriangleIndex& surface_;
  double distance_;
  unsigned threads_;
  std::vector<TrianglePlaces> known_;  // sorted, like near_
  std::vector<TrianglePlaces> near_;   // of the last result
};

/// Clears the flags of vertices within the distance of the surface.
void clear_near(const Mesh& surface, double distance, const std::vector<Vec3>& positions,
                std::vector<std::uint8_t>& flags);

/// Clears the flags of the corners of triangles of a mesh whose boxes come within the distance of
/// the boxes of the surface's triangles.
void clear_touched(const Mesh& surface, double distance, const Mesh& mesh,
                   std::vector<std::uint8_t>& flags);

}  // namespace meshfarm
