// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/staging/stage.hpp>

#include "pipeline/bake_stage.hpp"

namespace meshfarm {

/// Maximum side of a picture if nobody chose its size.
inline constexpr std::uint32_t k_most_chosen_side = 4096;

/// A new texture of a result: where its triangles lie on the picture, before it has colours.
struct TextureLayout {
  std::uint32_t size = 0;  // texels of a side
  std::uint32_t charts = 0;
  double coverage = 0;  // the share of the picture that charts cover
  double spacing = 0;   // of the texels on the surface, a length; 0 if that has no area
  /// For the input's pictures that have colours; nothing for others and for damaged ones.
  std::vector<std::optional<PictureFacts>> pictures;
};

/// Gives a result texture coordinates on one new picture; its columns are replaced. `texture_size`:
/// 0 for as many texels as the input's pictures have.
TextureLayout lay_out_texture(const Stage& stage, const Manifest& manifest,
                              std::uint32_t texture_size, unsigned threads, Mesh& result);

/// Inputs of a bake besides its layout.
struct BakeInput {
  /// The distance of the result from the input: surfaces nearer than this that face another way
  /// lose to those that face the same way.
  double reach = 0;
  unsigned threads = 0;  // 0: one per core
};

/// The output of a finish job: publishes a result that was laid out, in chunks, and what lies
/// between the input's parts. The manifest must be one of sorted streams. The outcome does not
/// depend on the threads. Memory: what lies between the parts, and one chunk.
JobOutput publish_bake_scene(const Stage& stage, const Manifest& manifest, const Mesh& result,
                             const TextureLayout& layout, const BakeInput& input, const Job& job,
                             const JobContext& context);

/// The picture as a file, a JPEG if all of the input's are: put together from the outputs of bake
/// jobs. Damaged pictures of the input are named in warnings. Memory: 19 bytes per texel.
PictureFiles baked_picture(const Stage& stage, const Manifest& manifest,
                           const TextureLayout& layout, const BakedTexture& baked,
                           unsigned threads);
/// A single material that uses the picture.
LabelMeaning baked_labels();

}  // namespace meshfarm
