// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

class Bvh;

/// A spatial index of a mesh's triangles, for several measurements in turn. The mesh must outlive
/// it, have a triangle and finite coordinates. About 20 bytes per triangle, 40 while it is built.
class TriangleIndex {
 public:
  TriangleIndex(const Mesh& mesh, unsigned threads);
  ~TriangleIndex();
  TriangleIndex(TriangleIndex&&) noexcept;

  const Mesh& mesh() const { return mesh_; }
  const Bvh& bvh() const { return *bvh_; }

 private:
  const Mesh& mesh_;
  std::unique_ptr<Bvh> bvh_;
};

/// The distance of each point from the mesh, in its unit; 0 for a point that is not finite. The
/// result does not depend on the threads.
std::vector<float> distances_to(const TriangleIndex& index, std::span<const Vec3> points,
                                unsigned threads);

}  // namespace meshfarm
