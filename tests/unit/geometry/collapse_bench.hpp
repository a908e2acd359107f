// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/simplify/adjacency.hpp"
#include "geometry/simplify/collapse_state.hpp"
#include "geometry/simplify/simplify_clean.hpp"
#include "geometry/simplify/simplify_lines.hpp"

namespace meshfarm::simplify_test {

/// A clean mesh and the data that a pass works on, before the first collapse.
struct CollapseBench {
  explicit CollapseBench(Mesh made, double crease_angle = 0)
      : mesh(std::move(made)), creases(crease_angle) {
    SimplifyOptions options;
    options.lines.crease_angle = crease_angle;
    flags = clean_surface(mesh, options, adjacency).flags;
    if (crease_angle > 0) CreaseLines(crease_angle, false).find(mesh, adjacency, flags);
    for (std::uint32_t v = 0; v < flags.size(); ++v) target.push_back(v);
    touched.assign(flags.size(), 0);
  }
  CollapseState state() {
    return {.positions = mesh.positions,
            .flags = flags,
            .target = target,
            .adjacency = &adjacency,
            .creases = &creases};
  }

  Mesh mesh;
  CreaseTest creases;
  Adjacency adjacency;
  std::vector<std::uint8_t> flags;
  std::vector<std::uint32_t> target;
  std::vector<std::uint8_t> touched;
};

}  // namespace meshfarm::simplify_test
