// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/labels.hpp>

#include "gltf_buffers.hpp"
#include "gltf_materials.hpp"
#include "gltf_meshes.hpp"

namespace meshfarm {

/// What is kept of a document's textures.
struct GltfMaps {
  bool uvs = false;  // triangles have texture coordinates
  PictureFiles pictures;
  std::size_t textures = 0;  // how many of the document's are maps of materials
  GltfSkipped skipped;       // "normalTexture": number of materials
  GltfSkipped read;          // "TEXCOORD_0": number of primitives
};

/// Gives the labels' materials their maps, and the triangles their texture coordinates, if they
/// have any: the set that places the picture of the material's colour, or else the first other
/// picture; without a picture TEXCOORD_0. A material's other maps are kept if they have the same
/// placement. v becomes 1 - v. Pictures that are missing or invalid are left out with a warning.
/// Throws DataError for malformed input.
GltfMaps keep_gltf_maps(const GltfValue& document, GltfBuffers& buffers, GltfMeshes& meshes,
                        GltfLabels& labels, const std::string& path);

}  // namespace meshfarm
