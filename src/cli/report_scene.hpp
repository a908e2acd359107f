// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/report/run_page.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// Measures and draws the page's meshes: sets page.figures and page.scene. The input is read from
/// the stage once as a whole, and once more in parts; of it points are kept, and all of it where it
/// is small. The result must have triangles. Depends on no threads (0: one a core).
void add_scene(RunPage& page, const Stage& stage, const Mesh& result, unsigned threads);

}  // namespace meshfarm
