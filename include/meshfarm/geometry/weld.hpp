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

/// Fewer vertices than this at one point may turn out to be separate (separate_touching). This many
/// or more are merged wherever they would otherwise have to fit into one machine's memory.
inline constexpr std::uint64_t k_crowd = 256;

/// Which vertices have the same position.
struct WeldResult {
  std::vector<std::uint32_t> first;  // for each vertex its lowest twin: itself if it has none below
  std::uint64_t merged = 0;          // vertices that have a lower twin
};

/// Finds vertices with exactly the same coordinates; -0.0 equals 0.0, and NaNs are equal if their
/// bits are. Takes fewer than 2^32 positions. Memory: up to 20 bytes per vertex.
WeldResult weld(std::span<const Vec3> positions);

/// Undoes merges that would make a vertex non-manifold although each of its twins was manifold:
/// where closed surfaces touch at a point or along an edge, or a neck has no width. Twins are
/// separated if the triangles of each form a closed fan; twins linked by triangles without area
/// count as one. Copies of one surface stay merged, and so do the vertices in `open`, which have
/// triangles elsewhere. Memory: 2 bytes per vertex; 5 more if any may be separated, and 16 for each
/// triangle corner there.
void separate_touching(std::span<const Triangle> triangles, std::span<const std::uint32_t> open,
                       WeldResult& welded);

}  // namespace meshfarm
