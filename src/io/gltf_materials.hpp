// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <nlohmann/json.hpp>

#include <meshfarm/io/labels.hpp>

#include "gltf_json.hpp"
#include "gltf_textures.hpp"

namespace meshfarm {

/// Whether a material says only that the mesh is not metallic, as in our own files without labels.
/// It counts as none.
bool is_plain_gltf_material(const nlohmann::json& material);

struct GltfLabels {
  std::optional<LabelMeaning> meaning;
  std::size_t materials = 0;  // how many of the document's became labels
};

/// Makes the materials of the meshes' triangles their labels, in the document's order; triangles
/// without a material come last. Nothing if none has one. Throws DataError for malformed input.
GltfLabels label_gltf_meshes(const GltfValue& document, GltfMeshes& meshes);

}  // namespace meshfarm
