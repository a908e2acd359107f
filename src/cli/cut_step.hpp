// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include <meshfarm/io/manifest.hpp>

#include "cli/options.hpp"

namespace meshfarm {

struct CutStep {
  std::string input;
  std::string stage;
  const CutWords& words;
  const TalkOptions& talk;
  const std::atomic<bool>& stop;
  /// Whether --cut auto uses the farm for a mesh of this many triangles, if the farm can cut it;
  /// may be empty.
  std::function<bool(std::uint64_t triangles)> farm_pays = {};
  /// The greatest error of the run that follows; 0: not known.
  Length error = {};
};

/// Cuts a file, or makes streams from it, in a stage without a manifest, with progress on stderr.
Manifest cut_to_stage(const CutStep& step);

/// Reports, in one line, the textures that were turned into colours, if any.
void tell_textures(const std::string& input, const MeshFileInfo& info);

}  // namespace meshfarm
