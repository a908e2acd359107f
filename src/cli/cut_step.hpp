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
  /// What --cut auto comes to for a mesh of so many triangles, if the farm can cut it; may be
  /// empty.
  std::function<bool(std::uint64_t triangles)> farm_pays = {};
};

/// Cuts a file, or makes streams of it, in a stage that holds no manifest yet, with progress on
/// stderr.
Manifest cut_to_stage(const CutStep& step);

/// Tells, in a line, which textures have become colours, if any.
void tell_textures(const std::string& input, const MeshFileInfo& info);

}  // namespace meshfarm
