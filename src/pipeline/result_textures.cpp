// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/result_textures.hpp"

#include <utility>

#include <meshfarm/io/channel_file.hpp>
#include <meshfarm/io/mesh_format.hpp>

#include "pipeline/texture_bake.hpp"

namespace meshfarm {

ResultTextures textures_of_result(const Stage& stage, const Manifest& manifest,
                                  const RunOptions& run, Mesh& result,
                                  const ResultTexturesOptions& options) {
  ResultTextures textures;
  if (!manifest.uvs) return textures;
  TexturesMade& made = textures.made;
  made.floor = texture_floor(manifest);
  made.way = TexturesMade::Way::dropped;
  const TextureMode mode = chosen_textures(manifest, run);
  if (!keeps_uvs(options.output)) {
    result.columns.uvs = {};
  } else if (mode == TextureMode::keep) {
    made.way = TexturesMade::Way::kept;
    made.pictures = manifest.pictures.size();
    textures.pictures = pictures_of(stage, manifest.pictures);
  } else if (mode == TextureMode::bake && manifest.labels) {
    BakedTexture baked = bake_texture(stage, manifest, result,
                                      {.reach = options.reach,
                                       .texture_size = run.texture_size,
                                       .threads = options.threads,
                                       .progress = options.progress});
    made.way = TexturesMade::Way::baked;
    made.size = baked.size;
    made.charts = baked.charts;
    made.charts_share = baked.coverage;
    textures.labels = std::move(baked.labels);
    textures.pictures = std::move(baked.pictures);
  }
  return textures;
}

}  // namespace meshfarm
