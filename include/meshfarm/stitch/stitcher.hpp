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
  Mesh mesh;  // the boundary triangles that were added come last
  /// Per vertex: whether it was a boundary vertex, locked in its part.
  std::vector<std::uint8_t> seam;
  std::vector<std::uint32_t> opened;     // ResultMesh::opened of all parts
  std::uint64_t boundary_triangles = 0;  // how many were added
  /// The vertices that boundary triangles share with parts that were not added, ordered by part and
  /// local index: the boundary vertices of the composed mesh.
  std::vector<std::uint32_t> open;
};

/// Joins simplified parts (Xiong et al. 2008, 3.3). Vertex lists are appended in the order of the
/// parts. Boundary vertices come first in each list and never move, so the corners of the boundary
/// triangles are found by part and local index.
///
/// A piece may also consist of several neighbours that were composed before (Xiong et al. 2008,
/// 4.3). Its boundary vertices are those that it shares with other pieces, as the boundary
/// triangles show.
class Stitcher {
 public:
  /// There are `all_parts` parts; those from `first` on will be added.
  explicit Stitcher(std::uint32_t all_parts, std::uint32_t first = 0)
      : all_parts_(all_parts), first_part_(first) {}
  /// Adds the next part, or a piece composed of the next `parts` parts. Throws DataError if the
  /// whole has too many vertices for 32-bit indices.
  void add(const ResultMesh& result, std::uint32_t parts = 1);
  /// Skips the next `parts` parts: they count as not added.
  void skip(std::uint32_t parts);
  /// Adds the boundary triangles between the pieces. `boundary` must also include those between a
  /// piece and parts that were not added. Throws DataError if a corner is not a boundary vertex.
  /// Labels: one per boundary triangle, or none.
  StitchedMesh finish(std::span<const BoundaryTriangle> boundary,
                      const TriangleColumnsView& columns = {});

 private:
  /// What one call has added.
  struct Piece {
    std::uint32_t parts = 1;
    std::uint32_t first_vertex = 0;
    std::uint32_t boundary_vertices = 0;
  };

  std::uint32_t piece_of(const BoundaryCorner& corner) const;
  /// Assigns a place to each possible corner, in the order of parts and local indices.
  void make_room(std::span<const BoundaryTriangle> boundary);
  std::size_t place_of(const BoundaryCorner& corner) const {
    return first_corner_[corner.part - first_part_] + corner.local;
  }
  void find_corners(std::span<const BoundaryTriangle> boundary);
  std::uint32_t vertex_of(const BoundaryCorner& corner) const;

  std::uint32_t all_parts_;
  std::uint32_t first_part_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> piece_of_part_;  // from first_part_ on
  std::vector<std::size_t> first_corner_;     // by part, from first_part_ on: its first place
  /// By place, for pieces of several parts: the number of the boundary vertex in the piece. For a
  /// single part it is the local index.
  std::vector<std::uint32_t> number_;
  StitchedMesh stitched_;
};

}  // namespace meshfarm
