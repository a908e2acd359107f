// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "gltf_document.hpp"

namespace meshfarm {

/// Whether a mesh has triangles and is small enough to be compressed, which is done in memory.
bool can_compress_glb(const GltfLayout& layout);

/// A .glb of the mesh whose plain bytes are `binary`, using KHR_mesh_quantization and
/// EXT_meshopt_compression, complete except for the images, which the caller appends, each with
/// zeros up to a multiple of 4. Takes twice the memory of these bytes.
///
/// Positions lie on one lattice for the whole mesh, with 2^16 steps along its longest axis. The
/// step is a power of two: so the error is at most half a step along each axis, and whole numbers
/// stay exact. Where this is too coarse for the triangles, the lattice has 2^18, 2^20 or 2^22
/// steps, and positions are floats on it; where that is still too coarse, they are the original
/// floats. Normals have 8 bits, colours are unchanged. Texture coordinates from 0 to 1 have 16
/// bits, others stay floats. Vertices and triangles keep their order, but not which corner of a
/// triangle is the first.
std::string compressed_glb(const GltfLayout& layout, const GltfBounds& bounds,
                           const GltfWords& words, std::string binary);

}  // namespace meshfarm
