// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace meshfarm {

/// Gives each texel of a square picture that is not set a blend of what is set round it, by the
/// means of squares of 2, 4, 8, ... texels. `is_set`: one a texel. Without any that is set all
/// become grey.
void fill_texels(std::vector<std::array<std::uint8_t, 3>>& texels,
                 std::vector<std::uint8_t>& is_set, std::uint32_t side, unsigned threads);

}  // namespace meshfarm
