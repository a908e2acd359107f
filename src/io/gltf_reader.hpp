// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"
#include "gltf_buffers.hpp"

namespace meshfarm {

/// Reads the triangles of the default scene as one mesh, with its nodes' transforms. Colours are
/// converted to sRGB. Throws DataError for malformed input, and for required extensions that are
/// not supported.
std::unique_ptr<MeshSource> open_glb(InputFile file, const OpenOptions& options);
std::unique_ptr<MeshSource> open_gltf(InputFile file, const OpenOptions& options);

}  // namespace meshfarm
