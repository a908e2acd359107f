// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <meshfarm/io/labels.hpp>

#include "gltf_buffers.hpp"
#include "gltf_column.hpp"
#include "gltf_json.hpp"
#include "gltf_meshes.hpp"

namespace meshfarm {

/// An extension of a value, if it has it.
std::optional<GltfValue> gltf_extension(const GltfValue& value, std::string_view name);

/// Reads an array that must have this many numbers; leaves them unchanged if it is absent.
void read_gltf_numbers(const GltfValue& value, std::string_view name, std::span<double> numbers);

/// A texture of a material and its placement: (u, v) of the accessor is
/// (u a[0] + v a[1] + a[2], u b[0] + v b[1] + b[2]) in the image, from its upper left corner.
struct GltfTexture {
  std::uint64_t texture = 0;           // of the document
  std::optional<std::uint64_t> image;  // of the document
  std::uint64_t set = 0;               // of texture coordinates
  TextureWrap wrap_u = TextureWrap::repeat;
  TextureWrap wrap_v = TextureWrap::repeat;
  std::array<double, 3> a{1, 0, 0};
  std::array<double, 3> b{0, 1, 0};

  bool lies_as(const GltfTexture& other) const {
    return set == other.set && wrap_u == other.wrap_u && wrap_v == other.wrap_v && a == other.a &&
           b == other.b;
  }
};

/// `info`: the value of a material's "baseColorTexture", and the like.
GltfTexture read_gltf_texture(const GltfValue& document, const GltfValue& info);

/// The name of an image in messages.
std::string gltf_image_name(const GltfValue& image, std::uint64_t number);
/// The file of an image.
std::shared_ptr<const GltfBuffer> open_gltf_image(const GltfValue& document, GltfBuffers& buffers,
                                                  const GltfValue& image);
/// All bytes of a file; DataError for more than 1 GiB.
std::string read_gltf_image(const GltfBuffer& file);

/// A set of texture coordinates of a primitive's vertices. Nothing if it has no such set.
std::optional<GltfColumn> open_gltf_places(const GltfValue& document, GltfBuffers& buffers,
                                           const GltfValue& primitive, std::uint64_t set,
                                           std::uint64_t vertices);

}  // namespace meshfarm
