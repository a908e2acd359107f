// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/io/png_file.hpp>
#include <meshfarm/render/render.hpp>

#include "render/canvas.hpp"

namespace meshfarm {

/// Makes pixels from samples: their mean, over the background. `open_sky` has one number per pixel,
/// the fraction of light that reaches it, or is empty.
Texels develop(const Canvas& canvas, const std::vector<float>& open_sky,
               const RenderOptions& options);

}  // namespace meshfarm
