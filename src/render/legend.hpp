// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <meshfarm/io/png_file.hpp>

#include "render/rasterizer.hpp"

namespace meshfarm {

/// How many pixels on the right of a picture a legend takes.
std::uint32_t legend_width(std::uint32_t picture_height);

/// Draws the scale of colours there, with the range and round numbers between, and what they are
/// of above it.
void draw_legend(Texels& picture, const std::string& title, const ValueRange& range,
                 const Srgb& ink);

/// A number in as few digits as tell it from another that is so much greater.
std::string number_text(double value, double step);

}  // namespace meshfarm
