// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <meshfarm/io/mesh_source.hpp>

#include "gltf_meshes.hpp"
#include "texture_colours.hpp"

namespace meshfarm {

/// Meshes by their numbers in the document.
using GltfMeshes = std::map<std::uint64_t, GltfMesh>;

/// Scans the triangles of a primitive of a mesh.
using GltfScan = std::function<void(const GltfTriangles& triangles, const GltfVertices& vertices,
                                    const std::function<void(const TriangleView&)>& take)>;

/// Describes the pictures that colour the meshes, one line each, for the user.
std::vector<std::string> describe_gltf_textures(const GltfValue& document, GltfBuffers& buffers,
                                                const GltfMeshes& meshes, LostPictures lost);

/// Samples the base colours' textures and factors of the meshes' materials, and sets where the
/// colours of each GltfVertices begin. Null if no texture colours them. Throws DataError for
/// malformed input, except in pictures.
std::unique_ptr<TextureColours> sample_gltf_textures(const GltfValue& document,
                                                     GltfBuffers& buffers, GltfMeshes& meshes,
                                                     const std::string& path, const GltfScan& scan,
                                                     std::uint64_t picture_bytes);

}  // namespace meshfarm
