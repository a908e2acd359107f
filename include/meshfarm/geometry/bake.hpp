// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

/// Red, green and blue, from 0 to 1.
using BakedColour = std::array<float, 3>;

/// Tells the colours at points of a mesh, where it has these normals of length 1. Called by several
/// threads at once, with up to k_most_baked_points points that are near each other. What it tells
/// must depend on these alone.
using ColoursAt = std::function<void(std::span<const Vec3> points, std::span<const Vec3> normals,
                                     std::span<BakedColour> colours)>;
inline constexpr std::size_t k_most_baked_points = 1024;

struct BakeOptions {
  std::uint32_t texture_size = 2048;  // texels a side
  /// So far round the triangles the texels have what the surface has there, as if it went on.
  std::uint32_t margin_texels = 4;
  std::uint32_t samples = 1;  // a side of a texel, which has their mean: 2 asks for 4 points
  /// Makes a mean of colours a level from 0 to 1; none: as it is. For colours that are linear in
  /// the light it is the curve of sRGB.
  double (*level_of)(double) = nullptr;
  unsigned threads = 0;  // 0: one a core
};

struct BakedPicture {
  std::uint32_t side = 0;
  std::vector<std::uint8_t> texels;  // red, green and blue, row by row from the top
  std::uint64_t covered = 0;         // texels that triangles touch
};

/// Paints a square picture with the colours of the triangles that lie on it: `uvs` are those of
/// their corners, from the lower left corner of the picture, v upwards. Texels that no triangle is
/// near to have a blend of what is round them, so that smaller copies of the picture do not darken.
/// The result does not depend on the threads. Memory: 16 bytes a texel.
BakedPicture bake(const Mesh& mesh, std::span<const std::array<std::array<float, 2>, 3>> uvs,
                  const BakeOptions& options, const ColoursAt& colours_at);

}  // namespace meshfarm
