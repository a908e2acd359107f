// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// Simplification looks at some points. Where the whole surface turns out to be beyond so many
/// times the bound that it was given, what is near stays as it was, and it begins again; so often,
/// all in all: the last is not looked at. Parts and seams are given shares of the run's bound
/// (k_bound_share_of_parts, k_bound_share), of which this makes about 1.08.
inline constexpr double k_most_beyond_of_part = 1.2;
inline constexpr double k_most_beyond_of_seam = 1.17;
inline constexpr int k_bounded_tries = 6;

/// How far round a piece that went astray the input stays as it was, in bounds: the piece is more
/// than one from all of it. It grows with each try.
constexpr double reach_of_astray(int tries) {
  return 1.2 + 0.2 * tries;
}

/// A triangle by its places, in an order of their own: vertices may be taken apart, or their
/// numbers change.
using TrianglePlaces = std::array<std::array<double, 3>, 3>;
TrianglePlaces places_of(const Mesh& mesh, const Triangle& t);

/// Those triangles of a surface, with an area, that are not proven to be within the distance of
/// another surface, which has some triangle (find_beyond).
Mesh part_beyond(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads);

/// Finds what of a result is too far from a surface. What it has seen near, it does not look at
/// again: of a result that was made once more, most is as it was.
class AstrayFinder {
 public:
  /// The surface, which must outlive it, has some triangle.
  AstrayFinder(const TriangleIndex& surface, double distance, unsigned threads);

  /// Does not look at these triangles, wherever they are.
  void pass_over(const Mesh& known);
  /// Triangles with an area that are not proven to be near; of large ones the pieces that are not.
  Mesh find(const Mesh& result);

 private:
  Mesh far_pieces(const Mesh& beyond) const;

  const TriangleIndex& surface_;
  double distance_;
  unsigned threads_;
  std::vector<TrianglePlaces> known_;  // both ascending
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
