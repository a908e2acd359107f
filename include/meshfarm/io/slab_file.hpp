// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// A vertex that is not merged with all others at its point, because surfaces touch there or a neck
/// has no width (geometry/weld.hpp, separate_touching).
struct ApartVertex {
  std::uint32_t place = 0;
  std::uint32_t sheet = 0;  // the vertices of one sheet are merged
  friend bool operator==(const ApartVertex&, const ApartVertex&) = default;
};

/// One share of a mesh. Vertices are in file order; boundary vertices are in any order, and some
/// are named more than once.
struct MeshShare {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> boundary;
  PositionType type = PositionType::float32;  // holds all positions exactly
  /// At the points of boundary vertices, ascending: either all vertices of a point or none. The
  /// numbering of a point's sheets does not depend on the order of the input.
  std::vector<ApartVertex> apart;
  std::vector<Appearance> appearances = {};  // one per vertex, or none
  TriangleColumns columns = {};              // of the triangles
};

/// A share of a mesh as a staged file. Vertices and triangles keep their order, which decides
/// between coincident vertices that are not welded. Positions must be exact in `slab.type`;
/// boundary vertices must be ascending and unique.
std::string encode_slab(const MeshShare& slab);
/// Throws DataError naming `what` for anything that encode_slab did not make.
MeshShare decode_slab(std::string_view file, std::string_view what);

}  // namespace meshfarm
