// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "gltf_document.hpp"

namespace meshfarm {

/// Whether a mesh is small enough to be compressed, which is done in memory, and has triangles.
bool can_compress_glb(const GltfLayout& layout);

/// A .glb of the mesh whose plain bytes are `binary`, by KHR_mesh_quantization and
/// EXT_meshopt_compression, whole but for the images, which come next, each with zeros up to a
/// multiple of 4. Takes twice the memory of these bytes.
///
/// Positions lie on one lattice for the whole mesh, of 2^16 steps along its longest axis, each of
/// them a power of two: so an error is half a step at most along each axis, and whole numbers stay
/// what they are. Where it is too coarse for the triangles the lattice has 2^18, 2^20 or 2^22
/// steps, and positions are floats on it; where that is, too, they are the floats that they were.
/// Normals have 8 bits, colours stay as they are. Texture coordinates
/// from 0 to 1 have 16 bits, others stay floats. Vertices and triangles keep their order, but not
/// which corner of a triangle is the first.
std::string compressed_glb(const GltfLayout& layout, const GltfBounds& bounds,
                           const GltfWords& words, std::string binary);

}  // namespace meshfarm
