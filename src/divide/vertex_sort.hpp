// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/sweep_order.hpp>

namespace meshfarm {

/// The indices of the vertices in sweep order; coincident ones by index. Empty if they are in that
/// order already. `type` is a type that fits all positions: float32 is sorted faster.
std::vector<std::uint32_t> sorted_vertices(std::span<const Vec3> positions, const SweepOrder& order,
                                           PositionType type);

}  // namespace meshfarm
