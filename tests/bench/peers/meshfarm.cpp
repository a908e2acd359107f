// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <meshfarm/geometry/simplify.hpp>

#include "peer.hpp"

namespace meshfarm::bench {
namespace {

Mesh simplify(Task task, Stopwatch& watch) {
  SimplifyOptions options;
  options.positions = task.positions;
  Box box;
  for (const Vec3& p : task.mesh.positions) box.add(p);
  // The default of --weight colour.
  if (!task.mesh.appearances.empty())
    options.lines.appearance_scale.length = 0.002 * box.diagonal();
  watch.start();
  Simplifier simplifier(std::move(task.mesh), options);
  SimplifyGoal goal;
  goal.triangles = task.target;
  simplifier.reduce(goal);
  watch.stop();
  return simplifier.mesh();
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"meshfarm kernel", MESHFARM_VERSION, simplify});
}
