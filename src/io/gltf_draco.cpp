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
#include <vector>

#ifdef MESHFARM_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#endif

#include <meshfarm/util/memory.hpp>

#include "gltf_texture_info.hpp"

namespace meshfarm {
namespace {

constexpr std::string_view k_name = "KHR_draco_mesh_compression";

#ifdef MESHFARM_DRACO

constexpr std::uint64_t k_most_draco_bytes = std::uint64_t{1} << 31;
constexpr std::string_view k_too_large = "is malformed, or takes more memory than there is";

bool is_read(std::string_view attribute) {
  return attribute == "POSITION" || attribute == "NORMAL" || attribute == "COLOR_0" ||
         attribute.starts_with("TEXCOORD_");
}

/// The glTF number of a component type; 0 if it has none.
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
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto made = decoder.DecodeMeshFromBuffer(&buffer);
    if (made.ok()) return std::move(made).value();
    extension.fail("is malformed: " + made.status().error_msg_string());
  } catch (const std::bad_alloc&) {
    extension.fail(std::string(k_too_large));
  } catch (const std::length_error&) {
    extension.fail("is malformed");
  }
}

void check_count(const GltfValue& accessor, std::uint64_t compressed) {
  const std::uint64_t count = accessor.at("count").whole();
  if (count == compressed) return;
  accessor.fail("has " + std::to_string(count) + " elements, but " + std::to_string(compressed) +
                " are compressed for it");
}

/// How many triangles the bytes claim, as far as is known before memory is allocated for them.
std::optional<std::uint64_t> told_triangles(const GltfValue& extension, const std::string& bytes) {
  draco::DecoderBuffer in;
  in.Init(bytes.data(), bytes.size());
  draco::DracoHeader head{};
  if (!draco::PointCloudDecoder::DecodeHeader(&in, &head).ok()) return std::nullopt;
  if (head.version_major != 2 || head.version_minor != 2) {
    extension.fail("is of version " + std::to_string(head.version_major) + "." +
                   std::to_string(head.version_minor) + " of Draco's format; glTF has 2.2");
  }
  if (head.encoder_type != draco::TRIANGULAR_MESH) return std::nullopt;
  in.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  draco::GeometryMetadata passed_over;
  if ((head.flags & METADATA_FLAG_MASK) != 0 &&
      !draco::MetadataDecoder().DecodeGeometryMetadata(&in, &passed_over)) {
    return std::nullopt;
  }
  std::uint8_t traversal = 0;
  std::uint32_t count = 0;
  const bool is_sequential = head.encoder_method == draco::MESH_SEQUENTIAL_ENCODING;
  if (!is_sequential && !(in.Decode(&traversal) && draco::DecodeVarint(&count, &in))) {
    return std::nullopt;
  }
  if (!draco::DecodeVarint(&count, &in)) return std::nullopt;
  return count;
}

void check_told(const GltfValue& extension, const GltfValue& indices, const std::string& bytes) {
  constexpr std::uint64_t k_triangles_a_byte = 4096;  // flat grids reach a few hundred
  constexpr std::uint64_t k_few = 1 << 20;
  const std::optional<std::uint64_t> told = told_triangles(extension, bytes);
  if (!told) return;
  check_count(indices, 3 * *told);
  if (*told > k_few + k_triangles_a_byte * bytes.size()) {
    extension.fail("is malformed: it tells of " + std::to_string(*told) + " triangles in " +
                   std::to_string(bytes.size()) + " bytes");
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
  check_count(accessor, mesh.num_points());
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
  check_count(accessor, std::uint64_t{3} * mesh.num_faces());
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

/// A compressed attribute that is to be read.
struct Wanted {
  std::uint64_t accessor = 0;
  GltfValue id;
};

std::vector<Wanted> wanted_of(const GltfValue& primitive) {
  const GltfValue attributes = primitive.at("attributes");
  const GltfValue ids = gltf_extension(primitive, k_name)->at("attributes");
  std::vector<Wanted> wanted;
  for (const auto& [name, id] : ids.json().items()) {
    const std::optional<GltfValue> index = attributes.find(name);
    if (index && is_read(name)) wanted.push_back({index->whole(), ids.at(name)});
  }
  return wanted;
}

/// The rest of the free memory is for what this process makes of the rows.
std::optional<std::uint64_t> decoder_memory() {
  const std::optional<MemoryRoom> room = available_memory();
  if (!room) return std::nullopt;
  return room->bytes / 4 * 3;
}

void unpack(const GltfValue& document, const GltfValue& primitive, const GltfValue& extension,
            GltfBuffers& buffers) {
  const auto packed = buffers.open_view(document, extension.at("bufferView").whole());
  if (packed->size > k_most_draco_bytes) extension.fail("is of more than 2 GiB");
  std::string bytes(packed->size, '\0');
  packed->read(0, bytes);
  std::vector<std::uint64_t> accessors{primitive.at("indices").whole()};
  for (const Wanted& wanted : wanted_of(primitive)) accessors.push_back(wanted.accessor);
  std::size_t taken = 0;
  const ApartEnd end = run_apart(
      [&](const SendBytes& send) { decode_draco(document, primitive, bytes, send); },
      [&](std::string rows) { buffers.keep_unpacked(accessors.at(taken++), std::move(rows)); },
      decoder_memory());
  if (end == ApartEnd::out_of_memory) extension.fail(std::string(k_too_large));
  if (end == ApartEnd::died) extension.fail("is malformed: the decoder of Draco crashes");
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

#ifdef MESHFARM_DRACO

void decode_draco(const GltfValue& document, const GltfValue& primitive, const std::string& bytes,
                  const SendBytes& send) {
  const GltfValue extension = *gltf_extension(primitive, k_name);
  const GltfValue accessors = document.at("accessors");
  const GltfValue indices = accessors.item(primitive.at("indices").whole());
  check_told(extension, indices, bytes);
  const std::unique_ptr<draco::Mesh> mesh = decode(extension, bytes);
  send(indices_of(indices, *mesh));
  for (const Wanted& wanted : wanted_of(primitive)) {
    const std::uint64_t number = wanted.id.whole();
    const draco::PointAttribute* attribute =
        number > UINT32_MAX ? nullptr
                            : mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(number));
    if (attribute == nullptr) wanted.id.fail("is no attribute of what is compressed");
    send(rows_of(accessors.item(wanted.accessor), *mesh, *attribute));
  }
}

#endif

bool unpack_draco(const GltfValue& document, const GltfValue& primitive, GltfBuffers& buffers) {
  const std::optional<GltfValue> extension = gltf_extension(primitive, k_name);
  if (!extension) return false;
  unpack(document, primitive, *extension, buffers);
  return true;
}

}  // namespace meshfarm
