// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/util/apart.hpp>

#include "gltf_buffers.hpp"
#include "gltf_json.hpp"

namespace meshfarm {

/// Decompresses the positions, normals, colours, texture coordinates and indices of a primitive
/// that KHR_draco_mesh_compression compressed, for its accessors; false if it is not compressed
/// this way. This is done in memory, in a process of its own: damaged bytes may crash the decoder,
/// or make it request any amount of memory. Throws DataError for what is malformed or does not fit
/// the accessors; and if the build is without Draco and there is no uncompressed data to read.
bool unpack_draco(const GltfValue& document, const GltfValue& primitive, GltfBuffers& buffers);

/// The task of that process: decompresses the bytes of such a primitive and sends the rows of its
/// indices, then those of its attributes. Only in a build with Draco.
void decode_draco(const GltfValue& document, const GltfValue& primitive, const std::string& bytes,
                  const SendBytes& send);

}  // namespace meshfarm
