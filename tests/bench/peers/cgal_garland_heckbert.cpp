// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "cgal.hpp"

namespace meshfarm::bench {
namespace {

/// Plane quadrics, with the placement that refuses flips, as the manual advises.
Mesh simplify(Task task, Stopwatch& watch) {
  namespace sms = CGAL::Surface_mesh_simplification;
  using Policies = sms::GarlandHeckbert_plane_policies<CgalMesh, CgalKernel>;
  using Placement = sms::Bounded_normal_change_placement<Policies::Get_placement>;
  CgalMesh mesh = to_cgal(task.mesh);
  task.mesh = {};
  watch.start();
  const Policies policies(mesh);
  sms::edge_collapse(mesh, FewEnoughTriangles(task.target),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(Placement(policies.get_placement())));
  watch.stop();
  return from_cgal(mesh);
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"CGAL Garland-Heckbert", CGAL_VERSION_STR, simplify});
}
