// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// A corner of a part that is not among those that were added.
constexpr std::uint32_t k_elsewhere = std::numeric_limits<std::uint32_t>::max();

void sort_unique(std::vector<BoundaryCorner>& corners) {
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
}

}  // namespace

void Stitcher::add(const ResultMesh& result, std::uint32_t parts) {
  Mesh& mesh = stitched_.mesh;
  const std::size_t first = mesh.positions.size();
  if (first + result.mesh.positions.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw DataError("the stitched mesh would have 2^32 vertices or more; ask for fewer triangles");
  }
  const auto offset = static_cast<std::uint32_t>(first);
  piece_of_part_.insert(piece_of_part_.end(), parts, static_cast<std::uint32_t>(pieces_.size()));
  pieces_.push_back({parts, offset, result.boundary_vertices, {}});
  append_vertices(VertexView(result.mesh), mesh);
  mesh.columns.append(result.mesh.columns);
  for (const Triangle& t : result.mesh.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  stitched_.seam.resize(first + result.boundary_vertices, 1);
  stitched_.seam.resize(mesh.positions.size(), 0);
}

void Stitcher::skip(std::uint32_t parts) {
  piece_of_part_.insert(piece_of_part_.end(), parts, k_elsewhere);
}

std::uint32_t Stitcher::piece_of(const BoundaryCorner& corner) const {
  if (corner.part >= all_parts_) {
    throw DataError("a boundary triangle names part " + std::to_string(corner.part) +
                    ", which is not there; cut the mesh again");
  }
  const std::uint32_t part = corner.part - first_part_;
  return corner.part >= first_part_ && part < piece_of_part_.size() ? piece_of_part_[part]
                                                                    : k_elsewhere;
}

/// A boundary vertex of a piece is a corner of a triangle that does not lie within the piece.
void Stitcher::find_corners(std::span<const BoundaryTriangle> boundary) {
  for (const BoundaryTriangle& t : boundary) {
    const std::array<std::uint32_t, 3> pieces = {piece_of(t[0]), piece_of(t[1]), piece_of(t[2])};
    if (pieces[0] == pieces[1] && pieces[1] == pieces[2]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (pieces[k] == k_elsewhere || pieces_[pieces[k]].parts == 1) continue;
      pieces_[pieces[k]].corners.push_back(t[k]);
    }
  }
  for (Piece& piece : pieces_) {
    if (piece.parts == 1) continue;
    sort_unique(piece.corners);
    if (piece.corners.size() != piece.boundary_vertices) {
      throw DataError("a composed result has " + std::to_string(piece.boundary_vertices) +
                      " boundary vertices where the boundary triangles tell of " +
                      std::to_string(piece.corners.size()));
    }
  }
}

std::uint32_t Stitcher::vertex_of(const BoundaryCorner& corner) const {
  const Piece& piece = pieces_[piece_of(corner)];
  if (piece.parts > 1) {
    const auto at = std::lower_bound(piece.corners.begin(), piece.corners.end(), corner);
    return piece.first_vertex + static_cast<std::uint32_t>(at - piece.corners.begin());
  }
  if (corner.local >= piece.boundary_vertices) {
    throw DataError("a boundary triangle names vertex " + std::to_string(corner.local) +
                    " of part " + std::to_string(corner.part) +
                    ", which is no boundary vertex there; cut the mesh again");
  }
  return piece.first_vertex + corner.local;
}

StitchedMesh Stitcher::finish(std::span<const BoundaryTriangle> boundary,
                              const TriangleColumnsView& columns) {
  find_corners(boundary);
  std::vector<BoundaryCorner> open;
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const BoundaryTriangle& t = boundary[i];
    const std::array<std::uint32_t, 3> pieces = {piece_of(t[0]), piece_of(t[1]), piece_of(t[2])};
    const auto elsewhere = std::count(pieces.begin(), pieces.end(), k_elsewhere);
    if (elsewhere > 0) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (pieces[k] != k_elsewhere) open.push_back(t[k]);
      }
    } else if (pieces[0] != pieces[1] || pieces[1] != pieces[2] || pieces_[pieces[0]].parts == 1) {
      stitched_.mesh.triangles.push_back({vertex_of(t[0]), vertex_of(t[1]), vertex_of(t[2])});
      stitched_.mesh.columns.append(columns, i);
      ++stitched_.boundary_triangles;
    }
  }
  sort_unique(open);
  for (const BoundaryCorner& corner : open) stitched_.open.push_back(vertex_of(corner));
  return std::move(stitched_);
}

}  // namespace meshfarm
