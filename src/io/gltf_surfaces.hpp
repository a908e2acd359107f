// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// A picture that a glTF can show: a PNG or a JPEG.
struct GltfImage {
  std::size_t picture = 0;
  const char* type = "";  // as glTF names it
  std::uint64_t bytes = 0;
  std::uint32_t side = 0;  // the longer one, in texels
  std::string uri = {};    // of the file, if it is not in the buffer
};

/// The images of the materials' pictures, each once, in the order of their first use. A picture of
/// another format is left out with a warning that names the mesh. Throws as PictureFiles::load
/// does.
std::vector<GltfImage> find_gltf_images(std::span<const Material* const> materials,
                                        const PictureFiles& pictures,
                                        const std::filesystem::path& mesh);

/// Makes materials, and the textures and samplers that they use.
class GltfSurfaces {
 public:
  using Json = nlohmann::ordered_json;

  explicit GltfSurfaces(std::span<const GltfImage> images);
  /// With those of its maps that are among the images.
  Json material(const Material& material);
  /// Adds "textures", "samplers" and "images"; those in the buffer have the views from `first_view`
  /// on.
  void finish(std::size_t first_view, Json& document) const;

 private:
  using Wraps = std::array<TextureWrap, 2>;
  std::size_t texture(std::size_t image, const Material& of);
  std::size_t sampler(const Wraps& wraps);

  std::span<const GltfImage> images_;
  std::map<std::size_t, std::size_t> image_of_;                            // by picture
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> texture_of_;  // by sampler and image
  std::map<Wraps, std::size_t> sampler_of_;
  Json textures_ = Json::array();
  Json samplers_ = Json::array();
};

}  // namespace meshfarm
