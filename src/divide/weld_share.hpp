// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/divide/weld_counts.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/slab_file.hpp>

namespace meshfarm {

/// Undoes merges of a share's vertices where surfaces touch: inside the share, and at its seams
/// where the share says so. Counts coincidences; dropped triangles are not known yet.
WeldCounts keep_apart(const MeshShare& share, WeldResult& welded);

}  // namespace meshfarm
