// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/result_file.hpp>

namespace meshfarm {

struct StitchedMesh {
  Mesh mesh;  // the boundary triangles that were added are its last
  /// A flag a vertex: it was a boundary vertex, locked in its part.
  std::vector<std::uint8_t> seam;
  std::uint64_t boundary_triangles = 0;  // how many were added
  /// The vertices that boundary triangles share with parts that were not added, in the order of
  /// part and local index: the boundary vertices of what was composed.
  std::vector<std::uint32_t> open;
};

/// Joins simplified parts (Xiong et al. 2008, 3.3): vertex lists are appended in the order of the
/// parts and their starts remembered; boundary vertices kept their place at the head of each list,
/// so the corners of the boundary triangles are found by part and local index.
///
/// Neighbours may have been composed before (the same, 4.3): their boundary vertices are those that
/// they share with others, which the same boundary triangles tell.
class Stitcher {
 public:
  /// Of so many parts in all, those from `first` on are going to be added.
  explicit Stitcher(std::uint32_t all_parts, std::uint32_t first = 0)
      : all_parts_(all_parts), first_part_(first) {}
  /// Adds the next part, or so many that were composed. Throws DataError if the whole outgrows
  /// 32-bit indices.
  void add(const ResultMesh& result, std::uint32_t parts = 1);
  /// Adds the boundary triangles that lie between what was added; of the others those that touch it
  /// are needed, too. Throws DataError if a corner names no boundary vertex.
  StitchedMesh finish(std::span<const BoundaryTriangle> boundary);

 private:
  /// What was added by one call.
  struct Piece {
    std::uint32_t parts = 1;
    std::uint32_t first_vertex = 0;
    std::uint32_t boundary_vertices = 0;
    /// What the boundary vertices are, ascending; of a single part their local indices tell.
    std::vector<BoundaryCorner> corners;
  };

  std::uint32_t piece_of(const BoundaryCorner& corner) const;
  void find_corners(std::span<const BoundaryTriangle> boundary);
  std::uint32_t vertex_of(const BoundaryCorner& corner) const;

  std::uint32_t all_parts_;
  std::uint32_t first_part_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> piece_of_part_;  // from first_part_ on
  StitchedMesh stitched_;
};

}  // namespace meshfarm
