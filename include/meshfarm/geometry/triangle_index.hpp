// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

class Bvh;

/// Where the triangles of a mesh are, for measures that look at one mesh after another. The mesh
/// must outlive it, have a triangle and finite coordinates. About 20 bytes a triangle, 40 while it
/// is built.
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

/// How far each point is from the mesh, in its unit; a point that is not finite is at 0. The result
/// does not depend on the threads.
std::vector<float> distances_to(const TriangleIndex& index, std::span<const Vec3> points,
                                unsigned threads);

}  // namespace meshfarm
