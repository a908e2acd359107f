// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// Whether vertices at the same position become one.
enum class Weld { exact, off };

/// Which vertices are one point.
struct WeldResult {
  std::vector<std::uint32_t> first;  // for each vertex its lowest twin: itself if it has none below
  std::uint64_t merged = 0;          // vertices that have a lower twin
};

/// Finds the vertices with exactly the same coordinates; -0.0 is 0.0, and what is not a number
/// equals what has the same bits. Takes fewer than 2^32 positions. Memory: up to 20 bytes a vertex.
WeldResult weld(std::span<const Vec3> positions);

/// Takes back merges that would make a vertex non-manifold whose twins were manifold each: where
/// closed surfaces touch in a point or along an edge, and where a neck of no width would be tied
/// off. Twins part if the triangles of each, or of each set of twins that triangles of no area link,
/// go once all round; copies of one surface stay one. Vertices named by `open` have triangles
/// elsewhere and stay merged. Memory: 2 bytes a vertex; where any may part 5 more, and 16 for each
/// corner of a triangle there.
void separate_touching(std::span<const Triangle> triangles, std::span<const std::uint32_t> open,
                       WeldResult& welded);

}  // namespace meshfarm
