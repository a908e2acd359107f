// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The parts of a material that are written: its name, baseColorFactor, alphaMode "BLEND" with an
// alpha below 1, and of its maps baseColorTexture, metallicRoughnessTexture, normalTexture,
// occlusionTexture and emissiveTexture. It is not metallic, unless a picture says so.
#include "gltf_surfaces.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "picture.hpp"

namespace meshfarm {
namespace {

int number_of(TextureWrap wrap) {
  if (wrap == TextureWrap::repeat) return 10497;
  return wrap == TextureWrap::mirror ? 33648 : 33071;
}

const char* name_of(MapUse use) {
  switch (use) {
    case MapUse::colour:
      return "baseColorTexture";
    case MapUse::normal:
      return "normalTexture";
    case MapUse::metal_and_roughness:
      return "metallicRoughnessTexture";
    case MapUse::occlusion:
      return "occlusionTexture";
    case MapUse::emission:
      break;
  }
  return "emissiveTexture";
}

std::optional<GltfImage> image_of(std::size_t picture, const std::string& bytes,
                                  const std::string& what) {
  try {
    const PictureHead head = read_picture_head(bytes);
    return GltfImage{.picture = picture,
                     .type = head.kind == PictureHead::Kind::png ? "image/png" : "image/jpeg",
                     .bytes = bytes.size(),
                     .side = std::max(head.width, head.height)};
  } catch (const DataError& error) {
    log_warning(what + " is left out, as glTF cannot show it: " + error.what());
    return std::nullopt;
  }
}

}  // namespace

std::vector<GltfImage> find_gltf_images(std::span<const Material* const> materials,
                                        const PictureFiles& pictures,
                                        const std::filesystem::path& mesh) {
  std::vector<GltfImage> made;
  std::set<std::size_t> seen;
  for (const Material* material : materials) {
    for (const MaterialMap& map : material->maps) {
      if (!seen.insert(map.picture).second) continue;
      const std::string what = mesh.string() + ": the picture " + pictures.names.at(map.picture);
      if (auto image = image_of(map.picture, pictures.load(map.picture), what)) {
        made.push_back(*std::move(image));
      }
    }
  }
  return made;
}

GltfSurfaces::GltfSurfaces(std::span<const GltfImage> images) : images_(images) {
  for (std::size_t i = 0; i < images.size(); ++i) image_of_[images[i].picture] = i;
}

GltfSurfaces::Json GltfSurfaces::material(const Material& material) {
  Json rough = Json::object();
  Json maps = Json::object();
  if (material.colour != Material().colour) rough["baseColorFactor"] = material.colour;
  for (const MaterialMap& map : material.maps) {
    const auto found = image_of_.find(map.picture);
    if (found == image_of_.end()) continue;
    const bool is_rough = map.use == MapUse::colour || map.use == MapUse::metal_and_roughness;
    (is_rough ? rough : maps)[name_of(map.use)] = {{"index", texture(found->second, material)}};
    if (map.use == MapUse::emission) maps["emissiveFactor"] = {1, 1, 1};
  }
  if (!rough.contains(name_of(MapUse::metal_and_roughness))) rough["metallicFactor"] = 0;
  Json made = {{"name", material.name}, {"pbrMetallicRoughness", rough}};
  made.update(maps);
  if (material.colour[3] < 1) made["alphaMode"] = "BLEND";
  return made;
}

std::size_t GltfSurfaces::texture(std::size_t image, const Material& of) {
  const std::size_t wraps = sampler({of.wrap_u, of.wrap_v});
  const auto [found, is_new] = texture_of_.try_emplace({wraps, image}, textures_.size());
  if (is_new) textures_.push_back({{"sampler", wraps}, {"source", image}});
  return found->second;
}

std::size_t GltfSurfaces::sampler(const Wraps& wraps) {
  const auto [found, is_new] = sampler_of_.try_emplace(wraps, samplers_.size());
  if (is_new) {
    samplers_.push_back({{"wrapS", number_of(wraps[0])}, {"wrapT", number_of(wraps[1])}});
  }
  return found->second;
}

void GltfSurfaces::finish(std::size_t first_view, Json& document) const {
  if (textures_.empty()) return;
  document["textures"] = textures_;
  document["samplers"] = samplers_;
  document["images"] = Json::array();
  for (const GltfImage& image : images_) {
    if (image.uri.empty()) {
      document["images"].push_back({{"bufferView", first_view++}, {"mimeType", image.type}});
    } else {
      document["images"].push_back({{"uri", image.uri}});
    }
  }
}

}  // namespace meshfarm
