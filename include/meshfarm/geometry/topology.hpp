// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Counts that describe a mesh. Degenerate: two equal corners (by index). Duplicate: the same three
/// vertices as an earlier triangle, in any order. Both are left out of the other counts, except
/// that duplicates still count as faces and towards their edges' valence.
struct Topology {
  std::uint64_t vertices = 0;       // all, used or not
  std::uint64_t used_vertices = 0;  // corners of a non-degenerate triangle
  std::uint64_t triangles = 0;      // all
  std::uint64_t degenerate = 0;
  std::uint64_t zero_area = 0;  // not degenerate by index, but without area
  std::uint64_t duplicate = 0;
  std::uint64_t edges = 0;
  std::uint64_t border_edges = 0;           // with one triangle
  std::uint64_t nonmanifold_edges = 0;      // with three triangles or more
  std::uint64_t orientation_conflicts = 0;  // a directed edge used twice
  /// Edges that triangles do not traverse equally often in both directions: a surface without such
  /// edges encloses a volume.
  std::uint64_t unmatched_edges = 0;
  std::uint64_t components = 0;  // of used vertices joined by triangles
  std::int64_t euler = 0;        // used vertices - edges + non-degenerate triangles
};

/// Measures `mesh`. Memory: about 12 bytes per triangle and 16 per vertex. Throws DataError if a
/// triangle names a vertex that does not exist.
Topology measure_topology(const Mesh& mesh);

/// One piece's contribution to a mesh's topology.
struct PieceTopology {
  Topology topology;                 // components: of the piece on its own
  std::vector<std::uint32_t> roots;  // of each shared vertex: the vertex that names its component
};

/// Measures a piece that shares vertices with triangles of other pieces. `shared` are those
/// vertices; `sides` are the sides of such triangles between two of them.
PieceTopology measure_piece(const Mesh& mesh, std::span<const std::array<std::uint32_t, 2>> sides,
                            std::span<const std::uint32_t> shared);

}  // namespace meshfarm
