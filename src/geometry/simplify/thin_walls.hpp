// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Flags as k_thin the vertices that may have another sheet within `reach`: those near triangles
/// that face the other way, by their centres. No sheet within `reach` is missed if triangles are
/// small beside it; most vertices that are flagged have one within twice that.
void flag_thin_walls(const Mesh& mesh, double reach, std::span<std::uint8_t> flags);

}  // namespace meshfarm
