// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace meshfarm {

// A colour's level as glTF has it, linear in the light, and as all other formats do: sRGB (IEC
// 61966-2-1). Both are from 0 to 1; what is beyond is clamped, what is not a number is 0. The curve
// is exact at the 256 levels of 8 bits and straight between them, so that the one function is the
// other's inverse, and the same on all machines.
double linear_of_srgb(double level);
double srgb_of_linear(double level);

/// The first function of the 256 levels of 8 bits.
const std::array<float, 256>& linear_floats();

}  // namespace meshfarm
