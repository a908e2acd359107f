// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The parts of a material that are read: baseColorTexture, or with
// KHR_materials_pbrSpecularGlossiness diffuseTexture; metallicRoughnessTexture, normalTexture,
// occlusionTexture, and emissiveTexture where emissiveFactor is not zero; KHR_texture_transform.
#include "gltf_maps.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "gltf_texture_info.hpp"
#include "kept_pictures.hpp"

namespace meshfarm {
namespace {

class ImageKeeper {
 public:
  ImageKeeper(const GltfValue& document, GltfBuffers& buffers, const std::string& path)
      : document_(document), buffers_(buffers), pictures_(path, log_warning) {}

  void add(const GltfMesh& mesh, const GltfValue& primitives, GltfTriangles& triangles,
           std::vector<Material>* materials) {
    const GltfTexture* lies = nullptr;
    if (triangles.material != GltfTriangles::k_no_material) {
      const auto [found, is_new] = known_.try_emplace(triangles.material);
      if (is_new) {
        Material ignored;
        found->second = read_material(
            triangles.material, materials != nullptr ? (*materials)[triangles.label] : ignored);
      }
      if (found->second) lies = &*found->second;
    }
    const GltfTexture plain;
    if (lies == nullptr) lies = &plain;
    const std::uint64_t vertices = mesh.vertices[triangles.vertices].positions.rows;
    std::optional<GltfColumn> column = open_gltf_places(
        document_, buffers_, primitives.item(triangles.primitive), lies->set, vertices);
    if (!column) return;
    ++made_.read["TEXCOORD_" + std::to_string(lies->set)];
    made_.uvs = made_.uvs || triangles.count() > 0;
    const auto& [u, v, one] = lies->b;
    triangles.uvs = GltfUvs{*std::move(column), lies->a, {-u, -v, 1 - one}, true};
  }

  GltfMaps take() && {
    made_.textures = textures_.size();
    made_.pictures = std::move(pictures_).files();
    return std::move(made_);
  }

 private:
  /// Gives a material its maps. Returns their placement; nothing if it has none.
  std::optional<GltfTexture> read_material(std::uint64_t number, Material& material) {
    const GltfValue value = document_.at("materials").item(number);
    std::optional<GltfTexture> first;
    if (const auto glossy = gltf_extension(value, "KHR_materials_pbrSpecularGlossiness")) {
      add_map(*glossy, "diffuseTexture", MapUse::colour, first, material);
      if (glossy->find("specularGlossinessTexture")) ++made_.skipped["specularGlossinessTexture"];
    } else if (const auto rough = value.find("pbrMetallicRoughness")) {
      add_map(*rough, "baseColorTexture", MapUse::colour, first, material);
      add_map(*rough, "metallicRoughnessTexture", MapUse::metal_and_roughness, first, material);
    }
    add_map(value, "normalTexture", MapUse::normal, first, material);
    add_map(value, "occlusionTexture", MapUse::occlusion, first, material);
    std::array<double, 3> emission{0, 0, 0};
    read_gltf_numbers(value, "emissiveFactor", emission);
    if (emission != std::array<double, 3>{0, 0, 0}) {
      add_map(value, "emissiveTexture", MapUse::emission, first, material);
    }
    if (first) {
      material.wrap_u = first->wrap_u;
      material.wrap_v = first->wrap_v;
    }
    return first;
  }

  void add_map(const GltfValue& value, const char* name, MapUse use,
               std::optional<GltfTexture>& first, Material& material) {
    const std::optional<GltfValue> info = value.find(name);
    if (!info) return;
    const GltfTexture texture = read_gltf_texture(document_, *info);
    if (first && !first->lies_as(texture)) {
      ++made_.skipped[name];
      return;
    }
    if (!first) first = texture;
    const std::optional<std::uint32_t> picture =
        texture.image ? picture_of(*texture.image) : std::nullopt;
    if (!picture) return;
    textures_.insert(texture.texture);
    material.maps.push_back({use, *picture});
  }

  std::optional<std::uint32_t> picture_of(std::uint64_t number) {
    const GltfValue image = document_.at("images").item(number);
    TextureImage made{gltf_image_name(image, number), {}};
    try {
      const std::shared_ptr<const GltfBuffer> file = open_gltf_image(document_, buffers_, image);
      made.load = [file] { return read_gltf_image(*file); };
    } catch (const Error& error) {  // treated like a picture that cannot be read
      made.load = [why = std::string(error.what())]() -> std::string { throw DataError(why); };
    }
    const std::optional<GltfValue> uri = image.find("uri");
    const std::optional<GltfValue> title = image.find("name");
    std::string wanted = "image_" + std::to_string(number);
    if (uri && !uri->text().starts_with("data:")) {
      wanted = decode_percents(uri->text()).value_or(uri->text());
    } else if (title && !title->text().empty()) {
      wanted = title->text();
    }
    return pictures_.number_of(std::to_string(number), wanted, made);
  }

  const GltfValue& document_;
  GltfBuffers& buffers_;
  KeptPictures pictures_;
  GltfMaps made_;
  std::map<std::uint64_t, std::optional<GltfTexture>> known_;
  std::set<std::uint64_t> textures_;
};

}  // namespace

GltfMaps keep_gltf_maps(const GltfValue& document, GltfBuffers& buffers, GltfMeshes& meshes,
                        GltfLabels& labels, const std::string& path) {
  ImageKeeper keeper(document, buffers, path);
  std::vector<Material>* const materials = labels.meaning ? &labels.meaning->materials : nullptr;
  for (auto& [number, mesh] : meshes) {
    const GltfValue primitives = document.at("meshes").item(number).at("primitives");
    for (GltfTriangles& triangles : mesh.triangles) {
      keeper.add(mesh, primitives, triangles, materials);
    }
  }
  GltfMaps made = std::move(keeper).take();
  if (made.uvs && materials != nullptr) return made;
  // Pictures have no meaning without texture coordinates, or without materials.
  for (std::size_t i = 0; materials != nullptr && i < materials->size(); ++i) {
    Material& each = (*materials)[i];
    each = {.name = each.name, .colour = each.colour};
  }
  made.pictures = {};
  made.textures = 0;
  if (!made.uvs) made.skipped = made.read = {};
  return made;
}

}  // namespace meshfarm
