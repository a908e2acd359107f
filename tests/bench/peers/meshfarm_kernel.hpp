// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <meshfarm/geometry/simplify.hpp>

#include "peer.hpp"

namespace meshfarm::bench {

/// The simplifier of one part, with the default of --weight colour if the mesh has colours.
inline Mesh simplify_by_kernel(Task task, Stopwatch& watch) {
  SimplifyOptions options;
  options.positions = task.positions;
  Box box;
  for (const Vec3& p : task.mesh.positions) box.add(p);
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

}  // namespace meshfarm::bench
