// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/labels.hpp>

#include "gltf_buffers.hpp"
#include "gltf_materials.hpp"
#include "gltf_meshes.hpp"

namespace meshfarm {

/// What is kept of the textures of a document.
struct GltfMaps {
  bool uvs = false;  // triangles have texture coordinates
  PictureFiles pictures;
  std::size_t textures = 0;  // of the document that are maps of materials
  GltfSkipped skipped;       // "normalTexture": of so many materials
  GltfSkipped read;          // "TEXCOORD_0": of so many primitives
};

/// Gives the labels' materials their maps, and triangles that have texture coordinates theirs: the
/// set that the picture of their material's colour lies by, or else the first other; without a
/// picture TEXCOORD_0. A material's other maps are kept if they lie as that one. v becomes 1 - v.
/// Pictures that are missing, or are none, are left out with a warning. Throws DataError for what
/// is malformed.
GltfMaps keep_gltf_maps(const GltfValue& document, GltfBuffers& buffers, GltfMeshes& meshes,
                        GltfLabels& labels, const std::string& path);

}  // namespace meshfarm
