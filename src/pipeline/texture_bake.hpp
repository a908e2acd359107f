// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct TextureBakeOptions {
  /// How far the result is from the input: what faces another way and is nearer than this gives
  /// way to what faces the same way.
  double reach = 0;
  std::uint32_t texture_size = 0;  // of a side; 0: as many texels as the input's pictures have
  unsigned threads = 0;            // 0: one a core
  std::function<void(std::string_view phase)> progress;
};

/// A texture that was made for a mesh.
struct BakedTexture {
  LabelMeaning labels;    // one material, of all triangles
  PictureFiles pictures;  // its picture
  std::uint32_t size = 0;
  std::uint32_t charts = 0;
  double coverage = 0;  // the share of the picture that charts cover
};

/// Gives a result new texture coordinates, and a picture of what the textures of the stage's input
/// show at the places of its surface that are nearest. The columns of the result are replaced. Of
/// the input as many parts are in memory as half of what is free holds, at least one a thread. The
/// outcome depends on neither threads nor memory.
BakedTexture bake_texture(const Stage& stage, const Manifest& manifest, Mesh& result,
                          const TextureBakeOptions& options);

}  // namespace meshfarm
