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

/// A corner of a part that was not added.
constexpr std::uint32_t k_elsewhere = std::numeric_limits<std::uint32_t>::max();
/// No part has this many boundary vertices.
constexpr std::uint32_t k_most_locals = std::uint32_t{1} << 30;

[[noreturn]] void fail_at(const BoundaryCorner& corner) {
  throw DataError("a boundary triangle names vertex " + std::to_string(corner.local) + " of part " +
                  std::to_string(corner.part) +
                  ", which is no boundary vertex there; cut the mesh again");
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
  pieces_.push_back({parts, offset, result.boundary_vertices});
  append_vertices(VertexView(result.mesh), mesh);
  mesh.columns.append(result.mesh.columns);
  for (const Triangle& t : result.mesh.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  for (const std::uint32_t v : result.opened) stitched_.opened.push_back(v + offset);
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

void Stitcher::make_room(std::span<const BoundaryTriangle> boundary) {
  std::vector<std::uint32_t> locals(piece_of_part_.size(), 0);  // by part: the last, plus 1
  for (const BoundaryTriangle& t : boundary) {
    for (const BoundaryCorner& corner : t) {
      if (piece_of(corner) == k_elsewhere) continue;
      if (corner.local >= k_most_locals) fail_at(corner);
      std::uint32_t& end = locals[corner.part - first_part_];
      end = std::max(end, corner.local + 1);
    }
  }
  first_corner_.assign(1, 0);
  for (const std::uint32_t end : locals) first_corner_.push_back(first_corner_.back() + end);
}

/// A boundary vertex of a composed piece is a corner of a triangle that does not lie within the
/// piece.
void Stitcher::find_corners(std::span<const BoundaryTriangle> boundary) {
  const auto is_composed = [](const Piece& piece) { return piece.parts > 1; };
  if (std::none_of(pieces_.begin(), pieces_.end(), is_composed)) return;
  number_.assign(first_corner_.back(), 0);
  for (const BoundaryTriangle& t : boundary) {
    const std::array<std::uint32_t, 3> pieces = {piece_of(t[0]), piece_of(t[1]), piece_of(t[2])};
    if (pieces[0] == pieces[1] && pieces[1] == pieces[2]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (pieces[k] != k_elsewhere && pieces_[pieces[k]].parts > 1) number_[place_of(t[k])] = 1;
    }
  }
  std::size_t part = 0;
  for (const Piece& piece : pieces_) {
    while (piece_of_part_[part] == k_elsewhere) ++part;
    const std::size_t end = part + piece.parts;
    const std::size_t place = first_corner_[part];
    part = end;
    if (piece.parts == 1) continue;
    std::uint32_t count = 0;
    for (std::size_t i = place; i < first_corner_[end]; ++i) {
      if (number_[i] != 0) number_[i] = count++;
    }
    if (count != piece.boundary_vertices) {
      throw DataError("a composed result has " + std::to_string(piece.boundary_vertices) +
                      " boundary vertices where the boundary triangles tell of " +
                      std::to_string(count));
    }
  }
}

std::uint32_t Stitcher::vertex_of(const BoundaryCorner& corner) const {
  const Piece& piece = pieces_[piece_of(corner)];
  if (piece.parts > 1) return piece.first_vertex + number_[place_of(corner)];
  if (corner.local >= piece.boundary_vertices) fail_at(corner);
  return piece.first_vertex + corner.local;
}

StitchedMesh Stitcher::finish(std::span<const BoundaryTriangle> boundary,
                              const TriangleColumnsView& columns) {
  make_room(boundary);
  find_corners(boundary);
  std::vector<std::uint32_t> open;  // the open vertices, by place
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const BoundaryTriangle& t = boundary[i];
    const std::array<std::uint32_t, 3> pieces = {piece_of(t[0]), piece_of(t[1]), piece_of(t[2])};
    const auto elsewhere = std::count(pieces.begin(), pieces.end(), k_elsewhere);
    if (elsewhere > 0) {
      if (open.empty()) open.assign(first_corner_.back(), k_elsewhere);
      for (std::size_t k = 0; k < 3; ++k) {
        if (pieces[k] != k_elsewhere) open[place_of(t[k])] = vertex_of(t[k]);
      }
    } else if (pieces[0] != pieces[1] || pieces[1] != pieces[2] || pieces_[pieces[0]].parts == 1) {
      stitched_.mesh.triangles.push_back({vertex_of(t[0]), vertex_of(t[1]), vertex_of(t[2])});
      stitched_.mesh.columns.append(columns, i);
      ++stitched_.boundary_triangles;
    }
  }
  std::erase(open, k_elsewhere);
  stitched_.open = std::move(open);
  return std::move(stitched_);
}

}  // namespace meshfarm
