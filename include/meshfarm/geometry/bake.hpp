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

/// Computes the colours at points of a mesh with these normals, of length 1. Called by several
/// threads at once, with up to k_most_baked_points points that are near each other. The result must
/// depend on the arguments alone.
using ColoursAt = std::function<void(std::span<const Vec3> points, std::span<const Vec3> normals,
                                     std::span<BakedColour> colours)>;
inline constexpr std::size_t k_most_baked_points = 1024;

struct BakeOptions {
  std::uint32_t texture_size = 2048;  // texels per side
  /// Up to this distance round the triangles, texels have the colours that the surface would have
  /// if it went on.
  std::uint32_t margin_texels = 4;
  std::uint32_t samples = 1;  // per texel side, averaged: 2 samples 4 points per texel
  /// Maps a mean of colours to a level from 0 to 1; null: identity. For colours linear in the
  /// light, this is the sRGB curve.
  double (*level_of)(double) = nullptr;
  unsigned threads = 0;  // 0: one per core
};

/// Triangles of a mesh, in mesh order, and where they lie on a square picture: from its lower left
/// corner, v upwards.
struct BakeSurface {
  std::vector<Vec3> positions;  // of the vertices
  std::vector<Vec3> normals;    // likewise, of length 1 or 0
  std::vector<Triangle> triangles;
  std::vector<CornerUvs> uvs;
  /// Whether a triangle's texels are wanted. The other triangles are included because texels may be
  /// nearer to them.
  std::vector<std::uint8_t> is_own;
};

/// The whole mesh.
BakeSurface surface_to_bake(const Mesh& mesh, std::span<const CornerUvs> uvs);

/// Adjacent texels in a row: from x on; rows are counted from below.
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

/// The colours of the texels whose nearest triangle is one of the surface's own, up to the margin.
/// The result does not depend on the threads, and no texel depends on which other triangles are
/// own. Memory: 100 bytes per triangle and 3 per texel.
BakedTexels bake_texels(const BakeSurface& surface, const BakeOptions& options,
                        const ColoursAt& colours_at);

struct BakedPicture {
  std::uint32_t side = 0;
  std::vector<std::uint8_t> texels;  // red, green and blue, row by row from the top
};

/// A square picture assembled from texels.
class BakedCanvas {
 public:
  explicit BakedCanvas(std::uint32_t side);
  /// Throws DataError if a run leaves the picture, or has no levels.
  void add(const BakedTexels& texels);
  /// Fills texels that were not added with a blend of those round them, so that smaller copies of
  /// the picture do not darken. Leaves the canvas empty. Memory: 16 bytes per texel.
  BakedPicture finish(unsigned threads = 0);

 private:
  std::uint32_t side_;
  std::vector<TexelLevels> texels_;
  std::vector<std::uint8_t> is_set_;
};

}  // namespace meshfarm
