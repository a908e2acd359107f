// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/texture/flat.hpp"

namespace meshfarm {

/// What is packed: a shape in a box from (0, 0) on, by its outline.
struct PackShape {
  Flat size;
  std::span<const std::array<Flat, 2>> outline;
};

/// Where a shape has come to lie.
struct PackPlace {
  std::uint8_t quarter_turns = 0;       // counter-clockwise, of the box with its margins
  std::uint16_t x = 0, y = 0;           // of the turned box, in texels
  std::uint16_t width = 0, height = 0;  // of the box before it is turned
};

struct Packing {
  double scale = 0;  // texels a unit
  std::uint32_t margin = 0;
  std::vector<PackPlace> places;

  /// From a shape's frame to texels.
  Flat placed(Flat p, const PackPlace& place) const;
};

struct PackOptions {
  std::uint32_t side = 0;    // texels of the picture
  std::uint32_t margin = 0;  // texels round each shape
  double area = 0;           // of all shapes, without what is between
};

/// Puts the shapes at the greatest scale, about, at which they fit, turned by quarters, with their
/// margins clear of each other. Takes a smaller margin where the shapes are so many that little but
/// margins would fit; 0 with shapes that overlap if it must.
Packing pack_shapes(std::span<const PackShape> shapes, const PackOptions& options);

}  // namespace meshfarm
