// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/sweep_order.hpp>

namespace meshfarm {

/// The vertices in sweep order, by their indices; coincident ones by index. Empty if that is the
/// order they are in. `type` is what all positions fit: float32 is sorted faster.
std::vector<std::uint32_t> sorted_vertices(std::span<const Vec3> positions, const SweepOrder& order,
                                           PositionType type);

}  // namespace meshfarm
