// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

#include "pipeline/texture_bake.hpp"

namespace meshfarm {

/// A newly made texture.
struct MadeTexture {
  TextureLayout layout;
  std::function<PictureFiles()> picture;
};

struct ResultTextures {
  TexturesMade made;
  PictureFiles pictures;
  std::optional<LabelMeaning> labels;  // of a picture that was made; else the stage's labels stay
};

/// The textures of a result: those of the stage, unchanged, or a new one that it was laid out on,
/// or none, depending on the run and the output's format. The result's columns are set accordingly.
ResultTextures textures_of_result(const Stage& stage, const Manifest& manifest,
                                  const RunOptions& run, const std::filesystem::path& output,
                                  const std::optional<MadeTexture>& made, Mesh& result);

}  // namespace meshfarm
