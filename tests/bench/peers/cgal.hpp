// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include "peer.hpp"

namespace meshfarm::bench {

using CgalKernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

/// A halfedge mesh must be manifold: where the input is not, its vertices are split.
inline CgalMesh to_cgal(const Mesh& mesh) {
  namespace soup = CGAL::Polygon_mesh_processing;
  std::vector<CgalKernel::Point_3> points;
  points.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  if (!soup::is_polygon_soup_a_polygon_mesh(triangles)) {
    soup::orient_polygon_soup(points, triangles);
  }
  CgalMesh out;
  soup::polygon_soup_to_polygon_mesh(points, triangles, out);
  return out;
}

inline Mesh from_cgal(CgalMesh& in) {
  in.collect_garbage();
  Mesh out;
  for (const CgalMesh::Vertex_index v : in.vertices()) {
    const CgalKernel::Point_3& p = in.point(v);
    out.positions.push_back({p.x(), p.y(), p.z()});
  }
  for (const CgalMesh::Face_index f : in.faces()) {
    Triangle t{};
    std::size_t corner = 0;
    for (const CgalMesh::Vertex_index v : in.vertices_around_face(in.halfedge(f))) {
      t.at(corner++) = static_cast<std::uint32_t>(v.idx());
    }
    out.triangles.push_back(t);
  }
  return out;
}

/// CGAL 5.5 counts edges; the number of triangles for a given edge count depends on the borders.
class FewEnoughTriangles {
 public:
  explicit FewEnoughTriangles(std::size_t target) : target_(target) {}
  template <class Cost, class Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
    return profile.surface_mesh().number_of_faces() <= target_;
  }

 private:
  std::size_t target_;
};

}  // namespace meshfarm::bench
