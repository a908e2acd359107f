// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/render/camera.hpp>
#include <meshfarm/render/render.hpp>

#include "render/canvas.hpp"

namespace meshfarm {

/// How much of the sky each pixel's surface sees, from 0 to 1, of which what stands near it hides a
/// part: hollows are darker. By the depths on the canvas alone. Takes 16 bytes a pixel. Of the
/// options quick and threads count.
std::vector<float> find_open_sky(const Canvas& canvas, const Camera& camera,
                                 const RenderOptions& options);

}  // namespace meshfarm
