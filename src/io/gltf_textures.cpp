// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The parts of a material that are read: baseColorTexture and baseColorFactor, or with
// KHR_materials_pbrSpecularGlossiness diffuseTexture and diffuseFactor; KHR_texture_transform. The
// alpha of both is ignored.
#include "gltf_textures.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "gltf_corners.hpp"
#include "gltf_texture_info.hpp"

namespace meshfarm {
namespace {

/// One of a mesh's primitives, and its material.
struct Primitive {
  const GltfTriangles* triangles = nullptr;
  const GltfVertices* vertices = nullptr;
  std::size_t material = 0;          // index in Surfaces::materials
  std::optional<GltfColumn> places;  // if the material has an image
};

/// The materials of the meshes' primitives, in the document's order.
class Surfaces {
 public:
  Surfaces(const GltfValue& document, GltfBuffers& buffers, const GltfMeshes& meshes)
      : document_(document), buffers_(buffers) {
    for (const auto& [number, mesh] : meshes) {
      const GltfValue primitives = document.at("meshes").item(number).at("primitives");
      for (const GltfTriangles& triangles : mesh.triangles) {
        add(triangles, mesh, primitives.item(triangles.primitive));
      }
    }
  }

  const std::vector<Primitive>& primitives() const { return primitives_; }
  const std::vector<TextureImage>& images() const { return images_; }
  const std::vector<TextureMaterial>& materials() const { return materials_; }

 private:
  struct Known {
    std::size_t material = 0;
    std::uint64_t set = 0;  // of texture coordinates
  };

  void add(const GltfTriangles& triangles, const GltfMesh& mesh, const GltfValue& primitive) {
    const std::uint64_t number = primitive.whole_or("material", k_no_material);
    const auto [found, is_new] = known_.try_emplace(number);
    if (is_new) found->second = read_material(number);
    Primitive made{.triangles = &triangles,
                   .vertices = &mesh.vertices[triangles.vertices],
                   .material = found->second.material};
    if (materials_[made.material].has_image()) {
      made.places = open_gltf_places(document_, buffers_, primitive, found->second.set,
                                     made.vertices->positions.rows);
      // A texture has no meaning without coordinates.
      if (!made.places) made.material = without_image(made.material);
    }
    primitives_.push_back(made);
  }

  std::size_t without_image(std::size_t material) {
    TextureMaterial plain = materials_[material];
    plain.image = TextureMaterial::k_no_image;
    materials_.push_back(plain);
    return materials_.size() - 1;
  }

  Known read_material(std::uint64_t number) {
    Known made{.material = materials_.size()};
    TextureMaterial material;
    if (number != k_no_material) {
      const GltfValue value = document_.at("materials").item(number);
      if (const auto glossy = gltf_extension(value, "KHR_materials_pbrSpecularGlossiness")) {
        made.set = read_base(*glossy, "diffuse", material);
      } else if (const auto rough = value.find("pbrMetallicRoughness")) {
        made.set = read_base(*rough, "baseColor", material);
      }
    }
    materials_.push_back(material);
    return made;
  }

  std::uint64_t read_base(const GltfValue& value, const std::string& name,
                          TextureMaterial& material) {
    std::array<double, 3> factor{1, 1, 1};
    read_gltf_numbers(value, name + "Factor", factor);
    for (std::size_t i = 0; i < 3; ++i) {
      material.factor[i] = static_cast<float>(std::clamp(factor[i], 0.0, 1.0));
    }
    material.plain = material.factor;
    const std::optional<GltfValue> info = value.find(name + "Texture");
    if (!info) return 0;
    const GltfTexture texture = read_gltf_texture(document_, *info);
    if (texture.image) material.image = image_of(*texture.image);
    material.wrap_u = texture.wrap_u;
    material.wrap_v = texture.wrap_v;
    material.a = texture.a;
    material.b = texture.b;
    return texture.set;
  }

  std::size_t image_of(std::uint64_t source) {
    const auto [found, is_new] = image_numbers_.try_emplace(source, images_.size());
    if (is_new) images_.push_back(make_image(source));
    return found->second;
  }

  TextureImage make_image(std::uint64_t source) {
    const GltfValue image = document_.at("images").item(source);
    return {gltf_image_name(image, source), [this, image] {
              return read_gltf_image(*open_gltf_image(document_, buffers_, image));
            }};
  }

  static constexpr std::uint64_t k_no_material = UINT64_MAX;
  const GltfValue& document_;
  GltfBuffers& buffers_;
  std::vector<Primitive> primitives_;
  std::vector<TextureImage> images_;
  std::vector<TextureMaterial> materials_;
  std::map<std::uint64_t, Known> known_;
  std::map<std::uint64_t, std::size_t> image_numbers_;
};

}  // namespace

std::vector<std::string> describe_gltf_textures(const GltfValue& document, GltfBuffers& buffers,
                                                const GltfMeshes& meshes, LostPictures lost) {
  return describe(Surfaces(document, buffers, meshes).images(), lost);
}

std::unique_ptr<TextureColours> sample_gltf_textures(const GltfValue& document,
                                                     GltfBuffers& buffers, GltfMeshes& meshes,
                                                     const std::string& path, const GltfScan& scan,
                                                     std::uint64_t picture_bytes) {
  std::uint64_t vertices = 0;
  for (auto& [number, mesh] : meshes) {
    for (GltfVertices& each : mesh.vertices) {
      each.texture_colours = vertices;
      vertices += each.positions.rows;
    }
  }
  const Surfaces surfaces(document, buffers, meshes);
  if (surfaces.images().empty()) return nullptr;
  auto colours = std::make_unique<TextureColours>(vertices, path);
  const auto scan_all = [&](const TextureColours::IsWanted& is_wanted,
                            const TextureColours::Add& add) {
    for (const Primitive& primitive : surfaces.primitives()) {
      if (!is_wanted(primitive.material)) continue;
      std::optional<GltfPlaces> places;
      if (primitive.places) places.emplace(GltfUvs{*primitive.places});
      const std::uint64_t first = primitive.vertices->texture_colours;
      scan(*primitive.triangles, *primitive.vertices, [&](std::span<const WideTriangle> batch) {
        for (const WideTriangle& triangle : batch) {
          TexturedTriangle made;
          for (std::size_t i = 0; i < 3; ++i) {
            made.vertices[i] = first + triangle[i];
            if (!places) continue;
            const Uv& place = places->at(triangle[i]);
            made.places[i] = {static_cast<double>(place[0]), static_cast<double>(place[1])};
          }
          add(made, primitive.material);
        }
      });
    }
  };
  const std::size_t sampled = colours->sample(surfaces.images(), surfaces.materials(),
                                              {.picture_bytes = picture_bytes}, scan_all);
  return sampled > 0 ? std::move(colours) : nullptr;
}

}  // namespace meshfarm
