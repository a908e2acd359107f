// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_column.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

namespace meshfarm {
namespace {

constexpr std::size_t k_most_stride = 252;

PlyType component_type(const GltfValue& accessor) {
  const GltfValue type = accessor.at("componentType");
  switch (type.whole()) {
    case 5120:
      return PlyType::int8;
    case 5121:
      return PlyType::uint8;
    case 5122:
      return PlyType::int16;
    case 5123:
      return PlyType::uint16;
    case 5125:
      return PlyType::uint32;
    case 5126:
      return PlyType::float32;
    default:
      type.fail("is not 5120 to 5123, 5125 or 5126");
  }
}

std::size_t component_count(const GltfValue& accessor) {
  const GltfValue type = accessor.at("type");
  if (type.text() == "SCALAR") return 1;
  if (type.text() == "VEC2") return 2;
  if (type.text() == "VEC3") return 3;
  if (type.text() == "VEC4") return 4;
  type.fail("is not SCALAR, VEC2, VEC3 or VEC4");
}

std::size_t stride_of(const GltfValue& view, std::size_t row_bytes) {
  const std::optional<GltfValue> stride = view.find("byteStride");
  if (!stride) return row_bytes;
  const std::uint64_t bytes = stride->whole();
  if (bytes < row_bytes || bytes > k_most_stride) {
    stride->fail("is not from " + std::to_string(row_bytes) + ", the size of what it holds, to " +
                 std::to_string(k_most_stride));
  }
  return bytes;
}

template <class T>
double component(const char* bytes, bool normalized) {
  const T value = load_ply<T, std::endian::little>(bytes);
  if constexpr (std::is_integral_v<T>) {
    if (normalized) {
      constexpr double k_most = std::numeric_limits<T>::max();
      return std::max(static_cast<double>(value) / k_most, -1.0);
    }
  }
  return static_cast<double>(value);
}

template <class T>
void decode(const GltfColumn& column, const char* row, std::span<Vec3> out) {
  const std::size_t stride = column.stride;
  const bool normalized = column.normalized;
  for (Vec3& p : out) {
    p = {component<T>(row, normalized), component<T>(row + sizeof(T), normalized),
         component<T>(row + 2 * sizeof(T), normalized)};
    row += stride;
  }
}

template <class T>
void decode(const GltfColumn& column, const char* row, std::span<std::array<double, 4>> out) {
  const std::size_t components = std::min<std::size_t>(column.components, 4);
  for (std::array<double, 4>& values : out) {
    for (std::size_t i = 0; i < components; ++i) {
      values[i] = component<T>(row + i * sizeof(T), column.normalized);
    }
    row += column.stride;
  }
}

template <class T>
void decode(const GltfColumn& column, const char* row, std::span<std::uint32_t> out) {
  for (std::uint32_t& value : out) {
    value = load_ply<T, std::endian::little>(row);
    row += column.stride;
  }
}

template <class Row>
void decode_any(const GltfColumn& column, const char* rows, std::span<Row> out) {
  switch (column.type) {
    case PlyType::int8:
      return decode<std::int8_t>(column, rows, out);
    case PlyType::uint8:
      return decode<std::uint8_t>(column, rows, out);
    case PlyType::int16:
      return decode<std::int16_t>(column, rows, out);
    case PlyType::uint16:
      return decode<std::uint16_t>(column, rows, out);
    case PlyType::uint32:
      return decode<std::uint32_t>(column, rows, out);
    default:
      return decode<float>(column, rows, out);
  }
}

}  // namespace

GltfColumn open_column(const GltfValue& document, std::uint64_t accessor, GltfBuffers& buffers) {
  const GltfValue value = document.at("accessors").item(accessor);
  if (value.find("sparse")) value.fail("is sparse, which meshfarm does not read");
  GltfColumn made{.rows = value.at("count").whole()};
  made.type = component_type(value);
  made.components = component_count(value);
  made.normalized = value.flag("normalized");
  const std::size_t row_bytes = made.components * size_of(made.type);
  if (auto unpacked = buffers.unpacked(accessor)) {
    made.stride = row_bytes;
    made.buffer = std::move(unpacked);
    return made;
  }
  const std::uint64_t index = value.at("bufferView").whole();
  made.stride = stride_of(document.at("bufferViews").item(index), row_bytes);
  made.buffer = buffers.open_view(document, index);
  const std::uint64_t view_bytes = made.buffer->size;
  const std::uint64_t offset = value.whole_or("byteOffset", 0);
  const std::uint64_t room = view_bytes - std::min(offset, view_bytes);
  const std::uint64_t fitting = room < row_bytes ? 0 : (room - row_bytes) / made.stride + 1;
  if (offset > view_bytes || made.rows > fitting) {
    value.fail("has " + std::to_string(made.rows) + " elements, but " + std::to_string(fitting) +
               " fit into its buffer view");
  }
  made.start = offset;
  return made;
}

const char* GltfColumnReader::fetch(const GltfColumn& column, std::uint64_t first,
                                    std::size_t rows) {
  if (rows == 0) return bytes_.data();
  // The last row need not be followed by a whole stride.
  bytes_.resize((rows - 1) * column.stride + column.components * size_of(column.type));
  column.buffer->read(column.start + first * column.stride, bytes_);
  return bytes_.data();
}

void GltfColumnReader::read(const GltfColumn& column, std::uint64_t first, std::span<Vec3> out) {
  decode_any(column, fetch(column, first, out.size()), out);
}

void GltfColumnReader::read(const GltfColumn& column, std::uint64_t first,
                            std::span<std::array<double, 4>> out) {
  decode_any(column, fetch(column, first, out.size()), out);
}

void GltfColumnReader::read(const GltfColumn& column, std::uint64_t first,
                            std::span<std::uint32_t> out) {
  const char* rows = fetch(column, first, out.size());
  switch (column.type) {
    case PlyType::uint8:
      return decode<std::uint8_t>(column, rows, out);
    case PlyType::uint16:
      return decode<std::uint16_t>(column, rows, out);
    default:
      return decode<std::uint32_t>(column, rows, out);
  }
}

}  // namespace meshfarm
