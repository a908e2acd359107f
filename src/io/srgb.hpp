// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace meshfarm {

// A level of a colour as in glTF, linear, and as in all other formats: sRGB (IEC 61966-2-1). Both
// are from 0 to 1; values outside are clamped, NaN becomes 0. The curve is exact at the 256 levels
// of 8 bits and linear between them, so that the two functions are each other's inverse, and the
// same on all machines.
double linear_of_srgb(double level);
double srgb_of_linear(double level);

/// linear_of_srgb() of the 256 levels of 8 bits.
const std::array<float, 256>& linear_floats();

}  // namespace meshfarm
