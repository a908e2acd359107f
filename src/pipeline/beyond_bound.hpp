// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/triangle_index.hpp>

namespace meshfarm {

/// Simplification looks at some points. Where the whole surface turns out to be beyond so many
/// times the bound that it was given, what is near stays as it was, and it begins again; so often,
/// all in all. Parts and seams are given shares of the run's bound (k_bound_share_of_parts,
/// k_bound_share): 1.08 of that is the most for both.
inline constexpr double k_most_beyond_of_part = 1.2;
inline constexpr double k_most_beyond_of_seam = 1.17;
inline constexpr int k_bounded_tries = 6;

/// In bounds: within that what is near stays when a piece went astray, which is farther than one
/// from all that it should be near. More each time, as the first may not have been enough.
constexpr double reach_of_astray(int tries) {
  return 1.2 + 0.2 * tries;
}

/// Those triangles of a surface, with an area, that are not proven to be within the distance of
/// another surface, which has some triangle (find_beyond).
Mesh part_beyond(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads);

/// The same, but of large triangles only the pieces that are beyond.
Mesh pieces_beyond(const Mesh& from, const TriangleIndex& to, double distance, unsigned threads);

/// Clears the flags of vertices within the distance of the surface.
void clear_near(const Mesh& surface, double distance, const std::vector<Vec3>& positions,
                std::vector<std::uint8_t>& flags);

/// Clears the flags of the corners of triangles of a mesh that come near the surface: within the
/// distance, or a little farther.
void clear_touched(const Mesh& surface, double distance, const Mesh& mesh,
                   std::vector<std::uint8_t>& flags);

}  // namespace meshfarm
