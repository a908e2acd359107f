// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

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

}  // namespace meshfarm
