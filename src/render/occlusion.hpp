// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/render/camera.hpp>
#include <meshfarm/render/render.hpp>

#include "render/canvas.hpp"

namespace meshfarm {

/// The fraction of the sky that each pixel's surface sees, from 0 to 1; nearby surfaces hide part
/// of it, so hollows are darker. Uses only the depths on the canvas. Takes 16 bytes per pixel. Of
/// the options only quick and threads matter.
std::vector<float> find_open_sky(const Canvas& canvas, const Camera& camera,
                                 const RenderOptions& options);

}  // namespace meshfarm
