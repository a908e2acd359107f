// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace meshfarm {

/// Fills each texel of a square picture that is not set with a blend of the set texels round it, by
/// the means of squares of 2, 4, 8, ... texels. `is_set`: one per texel. If none is set, all become
/// grey.
void fill_texels(std::vector<std::array<std::uint8_t, 3>>& texels,
                 std::vector<std::uint8_t>& is_set, std::uint32_t side, unsigned threads);

}  // namespace meshfarm
