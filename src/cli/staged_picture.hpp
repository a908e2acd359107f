// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/render/render.hpp>

namespace meshfarm {

/// Draws the input of a stage from its parts, coloured by part unless normals or no colours are
/// requested. Only some parts are in memory, never the whole. Throws UsageError for other colours.
Rendering render_stage(const std::string& folder, RenderOptions options);

}  // namespace meshfarm
