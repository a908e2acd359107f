// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/vec.hpp>
#include <meshfarm/render/colour_scale.hpp>

namespace meshfarm {

/// A colour by its amounts of light, 0 to 1.
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
/// Light above 1 is cut off.
Srgb srgb_of(Light light);
/// A colour in less light, from 0 to 1: by its square root.
Srgb dimmed(const Srgb& colour, float root_of_light);

/// In 24 bits.
constexpr std::uint32_t packed(const Srgb& colour) {
  return std::uint32_t{colour[0]} << 16 | std::uint32_t{colour[1]} << 8 | colour[2];
}
constexpr Srgb unpacked(std::uint32_t colour) {
  return {static_cast<std::uint8_t>(colour >> 16), static_cast<std::uint8_t>(colour >> 8),
          static_cast<std::uint8_t>(colour)};
}

/// What surfaces without colours have.
inline constexpr Srgb k_clay = {214, 209, 202};

/// Colours that can be told apart, over and over again.
Srgb colour_of_number(std::uint64_t number);

/// Of a direction of length 1: each axis is a component, from -1 (dark) to 1.
Srgb colour_of_direction(Vec3 direction);

/// How much of the light a surface gives back that faces this way, as the viewer sees it: x to the
/// right, y up, z toward the viewer. A soft light from the upper left, less from the other side,
/// from the viewer, and from the sky.
float light_on(Vec3 normal);

}  // namespace meshfarm
