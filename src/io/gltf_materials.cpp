// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The parts of a material that are read: its name, baseColorFactor, or with
// KHR_materials_pbrSpecularGlossiness diffuseFactor, and whether its alpha counts: alphaMode.
#include "gltf_materials.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "label_names.hpp"

namespace meshfarm {
namespace {

void read_factor(const GltfValue& value, std::string_view name, Material& material) {
  const std::optional<GltfValue> factor = value.find(name);
  if (!factor) return;
  if (factor->size() < material.colour.size()) factor->fail("is too short");
  for (std::size_t i = 0; i < material.colour.size(); ++i) {
    material.colour[i] = static_cast<float>(std::clamp(factor->item(i).real(), 0.0, 1.0));
  }
}

Material read_material(const GltfValue& value, std::uint64_t number) {
  Material made{.name = "material " + std::to_string(number)};
  if (const auto name = value.find("name"); name && !name->text().empty()) made.name = name->text();
  const std::optional<GltfValue> extensions = value.find("extensions");
  const auto glossy =
      extensions ? extensions->find("KHR_materials_pbrSpecularGlossiness") : std::nullopt;
  if (glossy) {
    read_factor(*glossy, "diffuseFactor", made);
  } else if (const auto rough = value.find("pbrMetallicRoughness")) {
    read_factor(*rough, "baseColorFactor", made);
  }
  const std::optional<GltfValue> mode = value.find("alphaMode");
  if (!mode || mode->text() == "OPAQUE") made.colour[3] = 1;
  return made;
}

}  // namespace

bool is_plain_gltf_material(const nlohmann::json& material) {
  const nlohmann::json plain = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
  return material == plain;
}

GltfLabels label_gltf_meshes(const GltfValue& document, GltfMeshes& meshes) {
  std::map<std::uint64_t, Label> labels;
  const auto for_triangles = [&meshes](const auto& use) {
    for (auto& [number, mesh] : meshes) {
      for (GltfTriangles& triangles : mesh.triangles) use(triangles);
    }
  };
  for_triangles([&](GltfTriangles& triangles) {
    if (triangles.material == GltfTriangles::k_no_material) return;
    const GltfValue material = document.at("materials").item(triangles.material);
    if (is_plain_gltf_material(material.json())) {
      triangles.material = GltfTriangles::k_no_material;
    } else {
      labels.emplace(triangles.material, 0);
    }
  });
  GltfLabels made{.meaning = {}, .materials = labels.size()};
  if (labels.empty()) return made;
  made.meaning = LabelMeaning{"material", {}};
  std::vector<Material>& materials = made.meaning->materials;
  FreeNames names;
  for (auto& [number, label] : labels) {
    label = static_cast<Label>(materials.size());
    materials.push_back(read_material(document.at("materials").item(number), number));
    names.take(materials.back().name);
  }
  const auto without = static_cast<Label>(materials.size());
  bool has_without = false;
  for_triangles([&](GltfTriangles& triangles) {
    const auto found = labels.find(triangles.material);
    triangles.label = found == labels.end() ? without : found->second;
    has_without = has_without || found == labels.end();
  });
  if (has_without) materials.push_back({.name = names.next("default")});
  return made;
}

}  // namespace meshfarm
