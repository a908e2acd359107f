// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace meshfarm {

/// A colour as files have it: sRGB.
using Srgb = std::array<std::uint8_t, 3>;

/// From dark blue (0) to yellow (1), evenly lighter; grey for what is not a number.
Srgb colour_on_scale(double place);

}  // namespace meshfarm
