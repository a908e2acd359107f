// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/io/png_file.hpp>
#include <meshfarm/render/render.hpp>

#include "render/canvas.hpp"

namespace meshfarm {

/// Makes pixels of samples: their mean, over the background. `open_sky` has one number a pixel, the
/// share of the light that comes to it, or none at all.
Texels develop(const Canvas& canvas, const std::vector<float>& open_sky,
               const RenderOptions& options);

}  // namespace meshfarm
