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
  std::optional<Vec3> up = {};  // the axis that points up; else by the input's shape
  std::optional<std::uint64_t> crossings = {};  // triangles of the result, if they are counted
  unsigned threads = 0;                         // 0: one a core
};

/// Measures and draws the page's meshes: sets page.figures and page.scene. The input is read from
/// the stage once as a whole, and once more in parts; of it points are kept, and all of it where it
/// is small. The result must have triangles. Depends on no threads.
void add_scene(RunPage& page, const Stage& stage, const Mesh& result, const SceneOptions& options);

}  // namespace meshfarm
