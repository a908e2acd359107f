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

/// Triangles of a mesh, in their order there, and where they lie on a square picture: from its
/// lower left corner, v upwards.
struct BakeSurface {
  std::vector<Vec3> positions;  // of the vertices
  std::vector<Vec3> normals;    // likewise, of length 1 or 0
  std::vector<Triangle> triangles;
  std::vector<CornerUvs> uvs;
  /// Whether its texels are wanted. The others are there because texels may be nearer to them.
  std::vector<std::uint8_t> is_own;
};

/// All of a mesh.
BakeSurface surface_to_bake(const Mesh& mesh, std::span<const CornerUvs> uvs);

/// Texels beside each other in a row: from x on, the row counted from below.
struct TexelRun {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t count = 0;
};
using TexelLevels = std::array<std::uint8_t, 3>;  // red, green, blue

/// Texels of a picture.
struct BakedTexels {
  std::vector<TexelRun> runs;
  std::vector<TexelLevels> levels;  // of the runs' texels, in order
};

/// The colours of the texels that the surface's own triangles are nearest to, up to the margin. The
/// result does not depend on the threads, and no texel's on which other triangles are own.
/// Memory: 100 bytes a triangle and 3 a texel.
BakedTexels bake_texels(const BakeSurface& surface, const BakeOptions& options,
                        const ColoursAt& colours_at);

struct BakedPicture {
  std::uint32_t side = 0;
  std::vector<std::uint8_t> texels;  // red, green and blue, row by row from the top
};

/// A square picture that is put together from texels.
class BakedCanvas {
 public:
  explicit BakedCanvas(std::uint32_t side);
  /// Throws DataError if a run leaves the picture, or has no levels.
  void add(const BakedTexels& texels);
  /// Texels that were not added have a blend of what is round them, so that smaller copies of the
  /// picture do not darken. Leaves the canvas empty. Memory: 16 bytes a texel.
  BakedPicture finish(unsigned threads = 0);

 private:
  std::uint32_t side_;
  std::vector<TexelLevels> texels_;
  std::vector<std::uint8_t> is_set_;
};

}  // namespace meshfarm
