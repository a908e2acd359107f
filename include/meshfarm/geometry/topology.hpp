// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Counts that tell what a mesh is. Degenerate: two equal corners (by index). Duplicate: the same
/// three vertices as an earlier triangle, in any order. Both are left out of the other counts,
/// except that duplicates still count as faces and towards their edges' valence.
struct Topology {
  std::uint64_t vertices = 0;       // all, used or not
  std::uint64_t used_vertices = 0;  // corners of a non-degenerate triangle
  std::uint64_t triangles = 0;      // all
  std::uint64_t degenerate = 0;
  std::uint64_t zero_area = 0;  // not degenerate by index, but of no area
  std::uint64_t duplicate = 0;
  std::uint64_t edges = 0;
  std::uint64_t border_edges = 0;           // one triangle
  std::uint64_t nonmanifold_edges = 0;      // three triangles or more
  std::uint64_t orientation_conflicts = 0;  // a directed edge used twice
  /// Those that triangles do not pass as often one way as the other: a surface without any of them
  /// encloses a volume.
  std::uint64_t unmatched_edges = 0;
  std::uint64_t components = 0;  // of used vertices joined by triangles
  std::int64_t euler = 0;        // used vertices - edges + non-degenerate triangles
};

/// Measures `mesh`. Memory: about 12 bytes a triangle and 16 a vertex.
/// Throws DataError if a triangle names a vertex that is not there.
Topology measure_topology(const Mesh& mesh);

/// What of a mesh's topology one piece of it tells.
struct PieceTopology {
  Topology topology;                 // components: as if there were nothing else
  std::vector<std::uint32_t> roots;  // of the shared vertices: a vertex that names the component
};

/// Measures a piece, some of whose vertices triangles share with other pieces. `shared` are those
/// vertices; `sides` those sides of such triangles that go from one to another of them.
PieceTopology measure_piece(const Mesh& mesh, std::span<const std::array<std::uint32_t, 2>> sides,
                            std::span<const std::uint32_t> shared);

}  // namespace meshfarm
