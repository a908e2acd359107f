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

/// A texture that was made anew.
struct MadeTexture {
  TextureLayout layout;
  std::function<PictureFiles()> picture;
};

struct ResultTextures {
  TexturesMade made;
  PictureFiles pictures;
  std::optional<LabelMeaning> labels;  // of a picture that was made; else those of the stage stay
};

/// The textures of a result: those of the stage as they are, or a new one that it was laid out on,
/// or none, as the run and the output's format say. The result's columns are set for it.
ResultTextures textures_of_result(const Stage& stage, const Manifest& manifest,
                                  const RunOptions& run, const std::filesystem::path& output,
                                  const std::optional<MadeTexture>& made, Mesh& result);

}  // namespace meshfarm
