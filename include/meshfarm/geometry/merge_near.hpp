// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// Merges positions that are near each other: finds for each the index of the position that it
/// takes, of its own or of one at most `distance` away. Those that stay are farther apart than
/// `distance`. Groups no wider than `distance`, and farther than that from all else, become one
/// position each. The positions taken do not depend on the order. Requires a finite distance above
/// 0 and fewer than 2^32 positions, all finite. Memory: about 80 bytes per position.
std::vector<std::uint32_t> merge_near(std::span<const Vec3> positions, double distance);

}  // namespace meshfarm
