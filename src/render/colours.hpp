// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/vec.hpp>
#include <meshfarm/render/colour_scale.hpp>

namespace meshfarm {

/// A colour in linear light, 0 to 1.
struct Light {
  float red = 0;
  float green = 0;
  float blue = 0;

  friend Light operator*(Light a, float s) { return {a.red * s, a.green * s, a.blue * s}; }
  friend Light operator+(Light a, Light b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
  }
};

Light light_of(const Srgb& colour);
/// Light above 1 is clamped.
Srgb srgb_of(Light light);
/// A colour in less light, given as the square root of a factor from 0 to 1.
Srgb dimmed(const Srgb& colour, float root_of_light);

/// The colour in 24 bits.
constexpr std::uint32_t packed(const Srgb& colour) {
  return std::uint32_t{colour[0]} << 16 | std::uint32_t{colour[1]} << 8 | colour[2];
}
constexpr Srgb unpacked(std::uint32_t colour) {
  return {static_cast<std::uint8_t>(colour >> 16), static_cast<std::uint8_t>(colour >> 8),
          static_cast<std::uint8_t>(colour)};
}

/// The colour of surfaces without colours.
inline constexpr Srgb k_clay = {214, 209, 202};

/// Distinguishable colours, repeating.
Srgb colour_of_number(std::uint64_t number);

/// The colour of a unit direction: each axis is a component, from -1 (dark) to 1.
Srgb colour_of_direction(Vec3 direction);

/// The fraction of light reflected by a surface with this normal in view coordinates: x to the
/// right, y up, z toward the viewer. A soft light comes from the upper left, less from the other
/// side, from the viewer, and from the sky.
float light_on(Vec3 normal);

}  // namespace meshfarm
