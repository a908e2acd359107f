// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Colours of a triangle's corners from a texture.
//
// A vertex stands for a third of each of its triangles: for the points that are nearer to it than
// to the other two corners, in barycentric coordinates. Its colour is the mean of the texels whose
// centres lie in these thirds, each texel once. Texels outside the triangle do not count, so that
// nothing bleeds in from beside a chart. Where a third has hardly any texels, the texture is
// interpolated at the third's centroid.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <meshfarm/io/labels.hpp>

#include "picture.hpp"

namespace meshfarm {

/// A place on a texture: 0 to 1 from the left, and from the top.
struct TexturePoint {
  double u = 0;
  double v = 0;
};

/// Linear red, green and blue, from 0 to 1.
using LinearColour = std::array<float, 3>;

struct Texture {
  const Picture& picture;
  TextureWrap wrap_u = TextureWrap::repeat;
  TextureWrap wrap_v = TextureWrap::repeat;
};

struct ThirdColours {
  std::array<LinearColour, 3> corners{};
  double texels = 0;  // the area of the triangle
};

/// Averages for a triangle with these corners. Nothing if one is not finite, or very far away.
std::optional<ThirdColours> average_thirds(const Texture& texture,
                                           const std::array<TexturePoint, 3>& corners);

}  // namespace meshfarm
