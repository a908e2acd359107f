// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <meshfarm/io/png_file.hpp>

#include "render/colours.hpp"

namespace meshfarm {

/// Lines of text on a picture.
struct Lettering {
  double left = 0;
  double top = 0;     // of capitals
  double height = 0;  // of capitals, in pixels
  Srgb colour{};
};

/// The width of a line, in pixels.
double width_of(std::string_view text, double height);

/// Draws digits, letters (lower case as capitals) and . , - + _ / ( ) %; other characters are drawn
/// as boxes. Text beyond the picture's sides is clipped.
void draw_text(Texels& picture, const Lettering& lettering, std::string_view text);

}  // namespace meshfarm
