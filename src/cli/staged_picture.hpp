// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/render/render.hpp>

namespace meshfarm {

/// Draws the input of a stage as it lies there, by part unless normals or nothing are asked for.
/// In memory are some parts, and none of the whole. Throws UsageError for other colours.
Rendering render_stage(const std::string& folder, RenderOptions options);

}  // namespace meshfarm
