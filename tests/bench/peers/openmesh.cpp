// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <cstdint>
#include <string>
#include <vector>

#include <OpenMesh/Core/System/config.h>

#include "peer.hpp"

namespace meshfarm::bench {
namespace {

/// Positions in double, like the quadrics; the status bits mark deleted elements.
struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};
using OmMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/// A halfedge mesh must be manifold: triangles that it refuses are left out.
void fill(OmMesh& out, const Mesh& mesh) {
  omerr().disable();
  out.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
  std::vector<OmMesh::VertexHandle> handles;
  handles.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) handles.push_back(out.add_vertex({p.x, p.y, p.z}));
  for (const Triangle& t : mesh.triangles) {
    out.add_face(handles[t[0]], handles[t[1]], handles[t[2]]);
  }
}

Mesh from_openmesh(OmMesh& in) {
  in.garbage_collection();
  Mesh out;
  for (const OmMesh::VertexHandle v : in.vertices()) {
    const OpenMesh::Vec3d& p = in.point(v);
    out.positions.push_back({p[0], p[1], p[2]});
  }
  for (const OmMesh::FaceHandle f : in.faces()) {
    Triangle t{};
    std::size_t corner = 0;
    for (auto v = in.cfv_iter(f); v.is_valid(); ++v) {
      t.at(corner++) = static_cast<std::uint32_t>(v->idx());
    }
    out.triangles.push_back(t);
  }
  return out;
}

Mesh simplify(Task task, Stopwatch& watch) {
  using Decimater = OpenMesh::Decimater::DecimaterT<OmMesh>;
  OmMesh mesh;
  fill(mesh, task.mesh);
  task.mesh = {};
  watch.start();
  Decimater decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<OmMesh>::Handle quadrics;
  decimater.add(quadrics);
  decimater.initialize();
  decimater.decimate_to_faces(0, task.target);
  watch.stop();
  return from_openmesh(mesh);
}

std::string version() {
  return std::to_string(OM_GET_VER) + "." + std::to_string(OM_GET_MAJ);
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"OpenMesh ModQuadric", version(), simplify});
}
