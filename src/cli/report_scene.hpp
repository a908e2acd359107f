// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/report/run_page.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct SceneOptions {
  std::optional<Vec3> up = {};  // the axis that points up; default: from the input's shape
  std::optional<std::uint64_t> crossings = {};  // triangles of the result, if they are counted
  unsigned threads = 0;                         // 0: one per core
};

/// Measures and draws the page's meshes: sets page.figures and page.scene. The input is read from
/// the stage once as a whole, and once more in parts; samples of it are kept, or all of it if it is
/// small. The result must have triangles. The output does not depend on the number of threads.
void add_scene(RunPage& page, const Stage& stage, const Mesh& result, const SceneOptions& options);

}  // namespace meshfarm
