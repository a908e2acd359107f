// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What is read of a material: baseColorTexture and baseColorFactor, or with
// KHR_materials_pbrSpecularGlossiness diffuseTexture and diffuseFactor; KHR_texture_transform. The
// alpha of both is passed over.
#include "gltf_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "gltf_column.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_image_bytes = std::uint64_t{1} << 30;

std::optional<GltfValue> extension_of(const GltfValue& value, std::string_view name) {
  const std::optional<GltfValue> extensions = value.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

/// Numbers of an array that is to have so many; as they are if it is absent.
template <std::size_t N>
void read_numbers(const GltfValue& value, std::string_view name, std::array<double, N>& numbers) {
  const std::optional<GltfValue> found = value.find(name);
  if (!found) return;
  if (found->size() < N) found->fail("is too short");
  for (std::size_t i = 0; i < N; ++i) {
    numbers[i] = found->item(i).real();
    if (!std::isfinite(numbers[i])) found->fail("is not of finite numbers");
  }
}

/// Sine and cosine of an angle, the same on all machines.
std::array<double, 2> sine_and_cosine(double angle) {
  constexpr double k_turn = 6.283185307179586;
  // Of a small angle by their series, and then of its doubles.
  constexpr int k_doublings = 6;
  double x = (angle - k_turn * std::floor(angle / k_turn)) / (1 << k_doublings);
  const double square = x * x;
  double sine = x * (1 - square / 6 * (1 - square / 20 * (1 - square / 42)));
  double cosine = 1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)));
  for (int i = 0; i < k_doublings; ++i) {
    const double doubled = 2 * sine * cosine;
    cosine = 1 - 2 * sine * sine;
    sine = doubled;
  }
  return {sine, cosine};
}

/// One of a mesh's primitives, and what colours it.
struct Primitive {
  const GltfTriangles* triangles = nullptr;
  const GltfVertices* vertices = nullptr;
  std::size_t material = 0;  // of Surfaces::materials
  std::uint64_t places = 0;  // the accessor of its TEXCOORD, if the material has an image
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
      const std::string name = "TEXCOORD_" + std::to_string(found->second.set);
      const std::optional<GltfValue> places = primitive.at("attributes").find(name);
      // Without coordinates a texture has no meaning.
      if (places) {
        made.places = places->whole();
      } else {
        made.material = without_image(made.material);
      }
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
      if (const auto glossy = extension_of(value, "KHR_materials_pbrSpecularGlossiness")) {
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
    read_numbers(value, name + "Factor", factor);
    for (std::size_t i = 0; i < 3; ++i) {
      material.factor[i] = static_cast<float>(std::clamp(factor[i], 0.0, 1.0));
    }
    material.plain = material.factor;
    const std::optional<GltfValue> info = value.find(name + "Texture");
    if (!info) return 0;
    const GltfValue texture = document_.at("textures").item(info->at("index").whole());
    const std::optional<std::uint64_t> source = source_of(texture);
    if (source) material.image = image_of(*source);
    if (const auto sampler = texture.find("sampler")) {
      const GltfValue wraps = document_.at("samplers").item(sampler->whole());
      material.wrap_u = wrap_of(wraps, "wrapS");
      material.wrap_v = wrap_of(wraps, "wrapT");
    }
    std::uint64_t set = info->whole_or("texCoord", 0);
    if (const auto transform = extension_of(*info, "KHR_texture_transform")) {
      read_transform(*transform, material);
      set = transform->whole_or("texCoord", set);
    }
    return set;
  }

  /// The image itself, before those that other formats may have beside it.
  static std::optional<std::uint64_t> source_of(const GltfValue& texture) {
    if (const auto source = texture.find("source")) return source->whole();
    for (const char* name :
         {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
      if (const auto other = extension_of(texture, name)) return other->at("source").whole();
    }
    return std::nullopt;
  }

  static TextureWrap wrap_of(const GltfValue& sampler, const char* name) {
    constexpr std::uint64_t k_repeat = 10497;
    constexpr std::uint64_t k_clamp = 33071;
    constexpr std::uint64_t k_mirror = 33648;
    switch (sampler.whole_or(name, k_repeat)) {
      case k_repeat:
        return TextureWrap::repeat;
      case k_clamp:
        return TextureWrap::clamp;
      case k_mirror:
        return TextureWrap::mirror;
      default:
        sampler.at(name).fail("is no way to wrap");
    }
  }

  /// offset * rotation * scale, as the extension's text has it.
  static void read_transform(const GltfValue& transform, TextureMaterial& material) {
    std::array<double, 2> offset{0, 0};
    std::array<double, 2> scale{1, 1};
    read_numbers(transform, "offset", offset);
    read_numbers(transform, "scale", scale);
    const std::optional<GltfValue> rotation = transform.find("rotation");
    const double angle = rotation ? rotation->real() : 0;
    if (!std::isfinite(angle)) rotation->fail("is not finite");
    const auto [sine, cosine] = sine_and_cosine(angle);
    material.a = {cosine * scale[0], sine * scale[1], offset[0]};
    material.b = {-sine * scale[0], cosine * scale[1], offset[1]};
  }

  std::size_t image_of(std::uint64_t source) {
    const auto [found, is_new] = image_numbers_.try_emplace(source, images_.size());
    if (is_new) images_.push_back(make_image(source));
    return found->second;
  }

  TextureImage make_image(std::uint64_t source) {
    const GltfValue image = document_.at("images").item(source);
    const std::optional<GltfValue> uri = image.find("uri");
    const bool is_file = uri && !uri->text().starts_with("data:");
    const std::optional<GltfValue> title = image.find("name");
    std::string name = "images[" + std::to_string(source) + "]";
    if (is_file || (title && !title->text().empty())) {
      name = shown(is_file ? uri->text() : title->text());
    }
    return {name, [this, image, uri] {
              const std::shared_ptr<const GltfBuffer> buffer =
                  uri ? buffers_.open_uri(*uri)
                      : buffers_.open_view(document_, image.at("bufferView").whole());
              if (buffer->size > k_most_image_bytes) {
                throw DataError("a picture of more than " + std::to_string(k_most_image_bytes) +
                                " bytes");
              }
              std::string bytes(buffer->size, '\0');
              buffer->read(0, bytes);
              return bytes;
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

/// The texture coordinates of a primitive's vertices, from the top.
class Places {
 public:
  Places(const GltfValue& document, GltfBuffers& buffers, const Primitive& primitive)
      : places_(primitive.vertices->positions.rows) {
    const GltfColumn column = open_column(document, primitive.places, buffers);
    if (column.components != 2 || column.rows != places_.size()) {
      throw DataError(primitive.triangles->place +
                      ": its texture coordinates are not of VEC2, or " +
                      "not as many as its positions");
    }
    GltfColumnReader reader;
    std::vector<std::array<double, 4>> rows;
    for (std::uint64_t done = 0; done < places_.size(); done += rows.size()) {
      rows.resize(std::min<std::uint64_t>(places_.size() - done, GltfColumnReader::k_most_rows));
      reader.read(column, done, rows);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        places_.items()[done + i] = {static_cast<float>(rows[i][0]),
                                     static_cast<float>(rows[i][1])};
      }
      places_.used(rows.size());
    }
  }
  TexturePoint at(std::uint64_t vertex) {
    places_.used(1);
    const std::array<float, 2>& place = places_.items()[vertex];
    return {static_cast<double>(place[0]), static_cast<double>(place[1])};
  }

 private:
  ScratchArray<std::array<float, 2>> places_;
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
      const bool has_image = surfaces.materials()[primitive.material].has_image();
      std::optional<Places> places;
      if (has_image) places.emplace(document, buffers, primitive);
      const std::uint64_t first = primitive.vertices->texture_colours;
      scan(*primitive.triangles, *primitive.vertices, [&](std::span<const WideTriangle> batch) {
        for (const WideTriangle& triangle : batch) {
          TexturedTriangle made;
          for (std::size_t i = 0; i < 3; ++i) {
            made.vertices[i] = first + triangle[i];
            if (places) made.places[i] = places->at(triangle[i]);
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
