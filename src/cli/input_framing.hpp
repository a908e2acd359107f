// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/render/camera.hpp>

namespace meshfarm {

/// Adds all vertices of a stage's input to framings. `seen` receives the number of triangles shown,
/// from several threads; may be empty.
void add_input(InputSurface& input, std::span<Framing> framings,
               const std::function<void(std::uint64_t)>& seen = {});

}  // namespace meshfarm
