// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct ResultTexturesOptions {
  std::filesystem::path output;
  double reach = 0;      // TextureBakeOptions::reach
  unsigned threads = 0;  // 0: one a core
  std::function<void(std::string_view phase)> progress;
};

struct ResultTextures {
  TexturesMade made;
  PictureFiles pictures;
  std::optional<LabelMeaning> labels;  // of a picture that was made; else those of the stage stay
};

/// The textures of a result: those of the stage as they are, or a new one, or none, as the run and
/// the output's format say. The result's columns are set for it.
ResultTextures textures_of_result(const Stage& stage, const Manifest& manifest,
                                  const RunOptions& run, Mesh& result,
                                  const ResultTexturesOptions& options);

}  // namespace meshfarm
