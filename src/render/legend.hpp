// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <meshfarm/io/png_file.hpp>

#include "render/rasterizer.hpp"

namespace meshfarm {

/// Width in pixels of a legend on the right of a picture.
std::uint32_t legend_width(std::uint32_t picture_height);

/// Draws the colour scale there, with the range and round numbers in between, and the title above.
void draw_legend(Texels& picture, const std::string& title, const ValueRange& range,
                 const Srgb& ink);

/// A number with just enough digits to distinguish it from one that differs by `step`.
std::string number_text(double value, double step);

}  // namespace meshfarm
