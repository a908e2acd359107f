// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/result_textures.hpp"

#include <meshfarm/io/channel_file.hpp>
#include <meshfarm/io/mesh_format.hpp>

namespace meshfarm {

ResultTextures textures_of_result(const Stage& stage, const Manifest& manifest,
                                  const RunOptions& run, const std::filesystem::path& output,
                                  const std::optional<MadeTexture>& made, Mesh& result) {
  ResultTextures textures;
  if (!manifest.uvs) return textures;
  TexturesMade& told = textures.made;
  told.floor = texture_floor(manifest);
  told.way = TexturesMade::Way::dropped;
  if (!keeps_uvs(output)) {
    result.columns.uvs = {};
    if (made) result.columns.labels = {};
  } else if (made) {
    told.way = TexturesMade::Way::baked;
    told.size = made->layout.size;
    told.charts = made->layout.charts;
    told.charts_share = made->layout.coverage;
    textures.labels = baked_labels();
    textures.pictures = made->picture();
  } else if (chosen_textures(manifest, run) == TextureMode::keep) {
    told.way = TexturesMade::Way::kept;
    told.pictures = manifest.pictures.size();
    textures.pictures = pictures_of(stage, manifest.pictures);
  }
  return textures;
}

}  // namespace meshfarm
