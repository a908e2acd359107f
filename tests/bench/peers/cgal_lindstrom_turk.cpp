// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "cgal.hpp"

namespace meshfarm::bench {
namespace {

/// CGAL's default cost and placement (Lindstrom & Turk 1998, 1999).
Mesh simplify(Task task, Stopwatch& watch) {
  CgalMesh mesh = to_cgal(task.mesh);
  task.mesh = {};
  watch.start();
  CGAL::Surface_mesh_simplification::edge_collapse(mesh, FewEnoughTriangles(task.target));
  watch.stop();
  return from_cgal(mesh);
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"CGAL Lindstrom-Turk", CGAL_VERSION_STR, simplify});
}
