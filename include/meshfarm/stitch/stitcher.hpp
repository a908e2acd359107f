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
  Mesh mesh;
  /// A flag a vertex: it was a boundary vertex, locked in its part.
  std::vector<std::uint8_t> seam;
};

/// Joins simplified parts (Xiong et al. 2008, 3.3): vertex lists are appended in the order of the
/// parts and their starts remembered; boundary vertices kept their place at the head of each list,
/// so the corners of the boundary triangles are found by part and local index.
class Stitcher {
 public:
  /// Adds the next part, number 0 first. Throws DataError if the whole outgrows 32-bit indices.
  void add(const ResultMesh& part);
  /// Adds the boundary triangles. Throws DataError if a corner names no boundary vertex.
  StitchedMesh finish(std::span<const BoundaryTriangle> boundary);

 private:
  std::vector<std::uint32_t> first_vertex_;
  std::vector<std::uint32_t> boundary_vertices_;
  StitchedMesh stitched_;
};

}  // namespace meshfarm
