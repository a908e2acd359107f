// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_draco.hpp"

#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#ifdef MESHFARM_DRACO
#include <draco/compression/decode.h>
#endif

#include "gltf_texture_info.hpp"

namespace meshfarm {
namespace {

constexpr std::string_view k_name = "KHR_draco_mesh_compression";

#ifdef MESHFARM_DRACO

constexpr std::uint64_t k_most_bytes = std::uint64_t{1} << 31;

bool is_read(std::string_view attribute) {
  return attribute == "POSITION" || attribute == "NORMAL" || attribute == "COLOR_0" ||
         attribute.starts_with("TEXCOORD_");
}

/// As glTF numbers the types of components; 0 for what it has not.
std::uint64_t component_type(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 5120;
    case draco::DT_UINT8:
      return 5121;
    case draco::DT_INT16:
      return 5122;
    case draco::DT_UINT16:
      return 5123;
    case draco::DT_UINT32:
      return 5125;
    case draco::DT_FLOAT32:
      return 5126;
    default:
      return 0;
  }
}

std::unique_ptr<draco::Mesh> decode(const GltfValue& extension, const std::string& bytes) {
  // The decoder may ask for as much memory as damaged bytes say.
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto made = decoder.DecodeMeshFromBuffer(&buffer);
    if (made.ok()) return std::move(made).value();
    extension.fail("is malformed: " + made.status().error_msg_string());
  } catch (const std::bad_alloc&) {
    extension.fail("is malformed, or takes more memory than there is");
  } catch (const std::length_error&) {
    extension.fail("is malformed");
  }
}

std::string rows_of(const GltfValue& accessor, const draco::Mesh& mesh,
                    const draco::PointAttribute& attribute) {
  static constexpr std::array<std::string_view, 5> k_shapes{"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto components = static_cast<std::size_t>(attribute.num_components());
  const bool has_shape =
      components < k_shapes.size() && accessor.at("type").text() == k_shapes[components];
  if (!has_shape || component_type(attribute.data_type()) != accessor.at("componentType").whole()) {
    accessor.fail("is of another type than what is compressed for it");
  }
  if (accessor.at("count").whole() != mesh.num_points()) {
    accessor.fail("has " + std::to_string(accessor.at("count").whole()) + " elements, but " +
                  std::to_string(mesh.num_points()) + " are compressed for it");
  }
  const std::size_t row_bytes =
      components * static_cast<std::size_t>(draco::DataTypeLength(attribute.data_type()));
  std::string rows(row_bytes * mesh.num_points(), '\0');
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
    if (value.value() >= attribute.size()) accessor.fail("is malformed where it is compressed");
    attribute.GetValue(value, rows.data() + i * row_bytes);
  }
  return rows;
}

template <class T>
std::string indices_of(const GltfValue& accessor, const draco::Mesh& mesh) {
  std::string rows(std::size_t{3} * mesh.num_faces() * sizeof(T), '\0');
  char* to = rows.data();
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(i))) {
      if (point.value() > std::numeric_limits<T>::max()) {
        accessor.fail("is of numbers that are too small for what is compressed for it");
      }
      for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        *to++ = static_cast<char>(point.value() >> 8 * byte & 0xff);
      }
    }
  }
  return rows;
}

std::string indices_of(const GltfValue& accessor, const draco::Mesh& mesh) {
  if (accessor.at("count").whole() != std::uint64_t{3} * mesh.num_faces()) {
    accessor.fail("has " + std::to_string(accessor.at("count").whole()) + " elements, but " +
                  std::to_string(std::uint64_t{3} * mesh.num_faces()) + " are compressed for it");
  }
  switch (accessor.at("componentType").whole()) {
    case 5121:
      return indices_of<std::uint8_t>(accessor, mesh);
    case 5123:
      return indices_of<std::uint16_t>(accessor, mesh);
    case 5125:
      return indices_of<std::uint32_t>(accessor, mesh);
    default:
      accessor.fail("is not of whole numbers without a sign");
  }
}

void unpack(const GltfValue& document, const GltfValue& primitive, const GltfValue& extension,
            GltfBuffers& buffers) {
  const auto packed = buffers.open_view(document, extension.at("bufferView").whole());
  if (packed->size > k_most_bytes) extension.fail("is of more than 2 GiB");
  std::string bytes(packed->size, '\0');
  packed->read(0, bytes);
  const std::unique_ptr<draco::Mesh> mesh = decode(extension, bytes);
  const GltfValue accessors = document.at("accessors");
  const GltfValue indices = primitive.at("indices");
  buffers.keep_unpacked(indices.whole(), indices_of(accessors.item(indices.whole()), *mesh));
  const GltfValue attributes = primitive.at("attributes");
  const GltfValue ids = extension.at("attributes");
  for (const auto& [name, id] : ids.json().items()) {
    const std::optional<GltfValue> index = attributes.find(name);
    if (!index || !is_read(name)) continue;
    const std::uint64_t number = ids.at(name).whole();
    const draco::PointAttribute* attribute =
        number > UINT32_MAX ? nullptr
                            : mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(number));
    if (attribute == nullptr) ids.at(name).fail("is no attribute of what is compressed");
    buffers.keep_unpacked(index->whole(),
                          rows_of(accessors.item(index->whole()), *mesh, *attribute));
  }
}

#else

void unpack(const GltfValue& document, const GltfValue& primitive, const GltfValue& extension,
            GltfBuffers& /*buffers*/) {
  static_cast<void>(document);
  static_cast<void>(primitive);
  extension.fail("is by Draco, which this meshfarm was built without (Debian's libdraco-dev)");
}

#endif

}  // namespace

bool unpack_draco(const GltfValue& document, const GltfValue& primitive, GltfBuffers& buffers) {
  const std::optional<GltfValue> extension = gltf_extension(primitive, k_name);
  if (!extension) return false;
  unpack(document, primitive, *extension, buffers);
  return true;
}

}  // namespace meshfarm
