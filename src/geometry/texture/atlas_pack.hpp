// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/texture/flat.hpp"

namespace meshfarm {

/// A shape to pack: its outline in a box from (0, 0) on.
struct PackShape {
  Flat size;
  std::span<const std::array<Flat, 2>> outline;
};

/// Where a shape was placed.
struct PackPlace {
  std::uint8_t quarter_turns = 0;       // counter-clockwise, of the box with its margins
  std::uint16_t x = 0, y = 0;           // of the turned box, in texels
  std::uint16_t width = 0, height = 0;  // of the box before it is turned
};

struct Packing {
  double scale = 0;  // texels per unit
  std::uint32_t margin = 0;
  std::vector<PackPlace> places;

  /// From a shape's frame to texels.
  Flat placed(Flat p, const PackPlace& place) const;
};

struct PackOptions {
  std::uint32_t side = 0;    // texels of the picture
  std::uint32_t margin = 0;  // texels round each shape
  double area = 0;           // of all shapes, without gaps
};

/// Packs the shapes at about the greatest scale at which they fit, turned by quarter turns, with
/// their margins not overlapping. If there are so many shapes that little but margins would fit,
/// uses a smaller margin; if unavoidable, margin 0 with overlapping shapes.
Packing pack_shapes(std::span<const PackShape> shapes, const PackOptions& options);

}  // namespace meshfarm
