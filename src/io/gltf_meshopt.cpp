// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_meshopt.hpp"

#include <optional>
#include <string>
#include <utility>

#include <meshoptimizer.h>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_meshopt_bytes = std::uint64_t{1} << 31;
/// No codec expands a byte to more: 16 rows of a column of bytes take at least two bits.
constexpr std::uint64_t k_most_growth = 256;

enum class Mode : std::uint8_t { attributes, triangles, indices };

struct Packed {
  Mode mode = Mode::attributes;
  std::string filter;
  std::uint64_t rows = 0;
  std::uint64_t stride = 0;
};

Mode mode_of(const GltfValue& mode) {
  if (mode.text() == "ATTRIBUTES") return Mode::attributes;
  if (mode.text() == "TRIANGLES") return Mode::triangles;
  if (mode.text() == "INDICES") return Mode::indices;
  mode.fail("is not ATTRIBUTES, TRIANGLES or INDICES");
}

/// The accessors rely on the view's sizes.
void check_view(const GltfValue& view, const Packed& packed) {
  const GltfValue length = view.at("byteLength");
  if (length.whole() != packed.rows * packed.stride) {
    length.fail("is " + std::to_string(length.whole()) + ", but its EXT_meshopt_compression has " +
                std::to_string(packed.rows) + " elements of " + std::to_string(packed.stride) +
                " bytes");
  }
  const std::optional<GltfValue> stride = view.find("byteStride");
  if (stride && stride->whole() != packed.stride) {
    stride->fail("is " + std::to_string(stride->whole()) + ", but " +
                 std::to_string(packed.stride) + " in its EXT_meshopt_compression");
  }
}

/// Checks what the decoders only assert.
Packed checked(const GltfValue& view, const GltfValue& compression,
               std::uint64_t compressed_bytes) {
  Packed made{.mode = mode_of(compression.at("mode"))};
  const std::optional<GltfValue> filter = compression.find("filter");
  made.filter = filter ? filter->text() : "NONE";
  made.rows = compression.at("count").whole();
  const GltfValue stride = compression.at("byteStride");
  made.stride = stride.whole();
  const bool fits = made.mode == Mode::attributes
                        ? made.stride > 0 && made.stride <= 256 && made.stride % 4 == 0
                        : made.stride == 2 || made.stride == 4;
  if (!fits) stride.fail("does not fit the mode");
  if (made.mode == Mode::triangles && made.rows % 3 != 0) {
    compression.at("count").fail("is no multiple of three");
  }
  const bool is_filter = made.filter == "NONE" || made.filter == "EXPONENTIAL" ||
                         (made.filter == "OCTAHEDRAL" && (made.stride == 4 || made.stride == 8)) ||
                         (made.filter == "QUATERNION" && made.stride == 8);
  if (!is_filter || (made.mode != Mode::attributes && made.filter != "NONE")) {
    compression.at("filter").fail("is not known, or does not fit the stride");
  }
  if (made.rows * made.stride > k_most_meshopt_bytes) {
    compression.fail("is of more than 2 GiB when it is decompressed");
  }
  check_view(view, made);
  if (compressed_bytes > k_most_meshopt_bytes) compression.fail("is of more than 2 GiB");
  if (made.rows * made.stride > k_most_growth * compressed_bytes) {
    compression.fail("is malformed: it is too short for its count");
  }
  return made;
}

int unpack(const Packed& packed, const std::string& from, std::string& to) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(from.data());
  switch (packed.mode) {
    case Mode::attributes:
      return meshopt_decodeVertexBuffer(to.data(), packed.rows, packed.stride, bytes, from.size());
    case Mode::triangles:
      return meshopt_decodeIndexBuffer(to.data(), packed.rows, packed.stride, bytes, from.size());
    default:
      return meshopt_decodeIndexSequence(to.data(), packed.rows, packed.stride, bytes, from.size());
  }
}

void unfilter(const Packed& packed, std::string& bytes) {
  if (packed.filter == "OCTAHEDRAL") {
    meshopt_decodeFilterOct(bytes.data(), packed.rows, packed.stride);
  } else if (packed.filter == "QUATERNION") {
    meshopt_decodeFilterQuat(bytes.data(), packed.rows, packed.stride);
  } else if (packed.filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(bytes.data(), packed.rows, packed.stride);
  }
}

}  // namespace

GltfBuffer decode_meshopt(const GltfValue& view, const GltfValue& compression,
                          const GltfBuffer& compressed, GltfStore& store) {
  const Packed packed = checked(view, compression, compressed.size);
  std::string from(compressed.size, '\0');
  compressed.read(0, from);
  std::string to(packed.rows * packed.stride, '\0');
  if (unpack(packed, from, to) != 0) compression.fail("is malformed");
  unfilter(packed, to);
  return store.keep(std::move(to));
}

}  // namespace meshfarm
