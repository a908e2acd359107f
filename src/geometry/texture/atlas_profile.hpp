// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/texture/atlas_pack.hpp"

namespace meshfarm {

using Height = std::int16_t;  // texels: a picture has at most 16,384 per side

/// A shape with its margins, in one orientation: the range that it covers in each column of texels.
struct Profile {
  std::vector<Height> low;
  std::vector<Height> high;
  long low_sum = 0;
  Height top = 0;
};

struct Raster {
  double scale = 0;
  std::uint32_t margin = 0;
  std::uint32_t column = 1;  // texels per column
};

/// The profiles of a shape in its four orientations.
class ShapeProfiles {
 public:
  /// False if the shape is larger than the picture.
  bool measure(const PackShape& shape, const Raster& raster, std::uint32_t side);
  int width() const { return width_; }
  int height() const { return height_; }
  /// The profile of the shape, turned by this many quarters.
  void turn(int quarters, Profile& to) const;

 private:
  std::size_t columns(double texels) const;
  void add_side(Flat a, Flat b, Profile& to) const;

  Raster raster_;
  int width_ = 0, height_ = 0;
  Profile by_x_, by_y_;
};

}  // namespace meshfarm
