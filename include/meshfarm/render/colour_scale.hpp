// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace meshfarm {

/// A colour as stored in files: sRGB.
using Srgb = std::array<std::uint8_t, 3>;

/// From dark blue (0) to yellow (1), with evenly increasing lightness; grey for NaN.
Srgb colour_on_scale(double place);

}  // namespace meshfarm
