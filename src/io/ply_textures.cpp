// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The input; v goes up from the picture's lower side:
//   "comment TextureFile" file               one a picture
//   of faces, list texcoord: { u v }         one a corner
//   of faces, texnumber                      which of the pictures, from 0
//   of vertices, s t | u v | texture_u texture_v | texture_s texture_t | tex_u tex_v
#include "ply_textures.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "kept_pictures.hpp"
#include "label_names.hpp"

namespace meshfarm {
namespace {

const PlyElement* faces_of(const PlyHeader& header) {
  for (const PlyElement& element : header.elements) {
    if (element.role == PlyRole::faces && element.count > 0) return &element;
  }
  return nullptr;
}

std::vector<PlyChannel> vertex_places(const PlyElement& vertices) {
  using Pair = std::array<std::string_view, 2>;
  static constexpr std::array<Pair, 5> k_pairs{{{"s", "t"},
                                                {"u", "v"},
                                                {"texture_u", "texture_v"},
                                                {"texture_s", "texture_t"},
                                                {"tex_u", "tex_v"}}};
  for (const Pair& pair : k_pairs) {
    std::vector<PlyChannel> made;
    for (const std::string_view name : pair) {
      for (std::size_t i = 0; i < vertices.properties.size(); ++i) {
        const PlyProperty& property = vertices.properties[i];
        if (property.name != name || property.is_list()) continue;
        made.push_back({{property.name, ChannelType::float32, ChannelRole::quality}, i});
      }
    }
    if (made.size() == pair.size()) return made;
  }
  return {};
}

}  // namespace

PlyTextures find_ply_textures(const PlyHeader& header) {
  PlyTextures made{.files = header.texture_files};
  const PlyElement* faces = faces_of(header);
  if (faces == nullptr) return made;
  for (std::size_t i = 0; i < faces->properties.size(); ++i) {
    const PlyProperty& property = faces->properties[i];
    if (property.name == "texcoord" && property.is_list()) made.face_list = i;
    const bool is_number = !property.is_list() && is_integer(property.type);
    if (property.name == "texnumber" && is_number && size_of(property.type) <= 4) made.numbers = i;
  }
  if (!made.face_list && !made.files.empty()) {
    made.of_vertices = vertex_places(header.vertices());
  }
  return made;
}

LabelMeaning keep_ply_pictures(const PlyTextures& textures, const std::filesystem::path& path,
                               const std::function<void(const std::string& line)>& warn,
                               PictureFiles& pictures) {
  KeptPictures kept(path.string(), warn);
  LabelMeaning made{"material", {}};
  FreeNames names;
  const std::vector<TextureImage> images = ply_images(textures, path);
  for (const TextureImage& image : images) {
    const std::string stem = std::filesystem::path(image.name).stem().string();
    Material material{.name = names.next(stem.empty() ? "material" : stem)};
    if (const auto number = kept.number_of(image.name, image.name, image)) {
      material.maps.push_back({MapUse::colour, *number});
    }
    made.materials.push_back(std::move(material));
  }
  if (textures.numbers) made.materials.push_back({.name = names.next("default")});
  pictures = std::move(kept).files();
  return made;
}

std::unique_ptr<TextureColours> sample_ply_textures(const PlySampling& sampling,
                                                    const PlyScan& scan) {
  std::vector<TextureMaterial> materials(sampling.textures.files.size() + 1);
  for (std::size_t i = 0; i + 1 < materials.size(); ++i) {
    materials[i].image = i;
    materials[i].b = {0, -1, 1};
  }
  auto colours = std::make_unique<TextureColours>(sampling.vertices, sampling.path.string());
  const auto scan_all = [&](const TextureColours::IsWanted& is_wanted,
                            const TextureColours::Add& add) {
    scan([&](const TriangleView& batch) {
      for (std::size_t i = 0; i < batch.size(); ++i) {
        const CornerUvs& uvs = batch.columns.uvs[i];
        // The coordinates of a face that has none.
        const bool has_none = uvs == CornerUvs{};
        const std::size_t material = has_none ? materials.size() - 1 : batch.columns.labels[i];
        if (!is_wanted(material)) continue;
        TexturedTriangle triangle{.vertices = batch.corners[i]};
        for (std::size_t k = 0; k < 3; ++k) {
          triangle.places[k] = {static_cast<double>(uvs[k][0]), static_cast<double>(uvs[k][1])};
        }
        add(triangle, material);
      }
    });
  };
  const std::size_t sampled =
      colours->sample(ply_images(sampling.textures, sampling.path), materials,
                      {.plain = sampling.plain, .picture_bytes = sampling.picture_bytes}, scan_all);
  return sampled > 0 ? std::move(colours) : nullptr;
}

std::vector<TextureImage> ply_images(const PlyTextures& textures,
                                     const std::filesystem::path& path) {
  std::vector<TextureImage> made;
  for (const std::string& file : textures.files) {
    made.push_back(picture_beside(path.parent_path(), file));
  }
  return made;
}

void PlyTexturedBatch::add_vertices(const ChannelPoints& batch) {
  for (std::size_t i = 0; i < batch.points.size(); ++i) {
    Uv uv{batch.values[2 * i], batch.values[2 * i + 1]};
    for (float& each : uv) {
      if (!std::isfinite(each)) each = 0;
    }
    places_.items()[done_++] = uv;
  }
  places_.used(batch.points.size());
}

TriangleView PlyTexturedBatch::of(const TriangleView& batch) {
  TriangleColumnsView columns = batch.columns;
  if (!textures_.of_vertices.empty()) {
    uvs_.resize(batch.size());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) uvs_[i][k] = places_.items()[batch.corners[i][k]];
    }
    places_.used(3 * batch.size());
    columns.uvs = uvs_;
  }
  if (!textures_.files.empty()) {
    const auto most = static_cast<Label>(textures_.files.size());
    labels_.assign(batch.size(), 0);
    for (std::size_t i = 0; i < columns.labels.size(); ++i) {
      labels_[i] = std::min(columns.labels[i], most);
    }
    columns.labels = labels_;
  }
  return {batch.corners, columns};
}

}  // namespace meshfarm
