// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_binary_records.hpp"

#include <cmath>

namespace meshfarm {
namespace {

template <class T, std::endian Order>
void decode_xyz(const char* record, std::size_t record_bytes, std::span<Vec3> out) {
  for (Vec3& vertex : out) {
    vertex = {static_cast<double>(load_ply<T, Order>(record)),
              static_cast<double>(load_ply<T, Order>(record + sizeof(T))),
              static_cast<double>(load_ply<T, Order>(record + 2 * sizeof(T)))};
    record += record_bytes;
  }
}

template <std::endian Order>
bool has_six(const TriangleLayout& layout, const char* record) {
  if (!layout.six) return true;
  return load_whole<Order>(layout.six->count_type, record + layout.six->offset) == 6;
}

template <class Count, class Index, std::endian Order>
std::size_t decode(const TriangleLayout& layout, const char* records, std::uint64_t vertices,
                   std::span<WideTriangle> out) {
  const char* list = records + layout.list_offset;
  // Via int64: a negative index becomes one that is out of any range.
  const auto index = [&list](std::size_t corner) {
    const char* bytes = list + sizeof(Count) + corner * sizeof(Index);
    return static_cast<std::uint64_t>(std::int64_t{load_ply<Index, Order>(bytes)});
  };
  for (std::size_t i = 0; i < out.size(); ++i, list += layout.record_bytes) {
    if (load_ply<Count, Order>(list) != 3) return i;
    if (!has_six<Order>(layout, list - layout.list_offset)) return i;
    const WideTriangle triangle{index(0), index(1), index(2)};
    if (std::max({triangle[0], triangle[1], triangle[2]}) >= vertices) return i;
    out[i] = triangle;
  }
  return out.size();
}

template <class Count, std::endian Order>
std::size_t decode(const TriangleLayout& layout, const char* records, std::uint64_t vertices,
                   std::span<WideTriangle> out) {
  return layout.index_type == PlyType::int32
             ? decode<Count, std::int32_t, Order>(layout, records, vertices, out)
             : decode<Count, std::uint32_t, Order>(layout, records, vertices, out);
}

}  // namespace

VertexLayout vertex_layout(const PlyElement& element) {
  VertexLayout layout;
  std::vector<std::size_t> offsets;
  for (const PlyProperty& property : element.properties) {
    offsets.push_back(layout.record_bytes);
    layout.record_bytes += size_of(property.type);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    layout.offsets[axis] = offsets[element.axes[axis]];
    layout.types[axis] = element.properties[element.axes[axis]].type;
  }
  return layout;
}

template <std::endian Order>
void decode_vertices(const VertexLayout& layout, const char* records, std::span<Vec3> out) {
  const PlyType type = layout.types[0];
  const std::size_t first = layout.offsets[0];
  const std::size_t size = size_of(type);
  const bool together = layout.types[1] == type && layout.types[2] == type &&
                        layout.offsets[1] == first + size && layout.offsets[2] == first + 2 * size;
  if (together && type == PlyType::float32) {
    decode_xyz<float, Order>(records + first, layout.record_bytes, out);
  } else if (together && type == PlyType::float64) {
    decode_xyz<double, Order>(records + first, layout.record_bytes, out);
  } else {
    for (Vec3& vertex : out) {
      vertex = {load_real<Order>(layout.types[0], records + layout.offsets[0]),
                load_real<Order>(layout.types[1], records + layout.offsets[1]),
                load_real<Order>(layout.types[2], records + layout.offsets[2])};
      records += layout.record_bytes;
    }
  }
}

template void decode_vertices<std::endian::little>(const VertexLayout&, const char*,
                                                   std::span<Vec3>);
template void decode_vertices<std::endian::big>(const VertexLayout&, const char*, std::span<Vec3>);

std::optional<TriangleLayout> triangle_layout(const PlyElement& element) {
  if (element.role != PlyRole::faces) return std::nullopt;
  const PlyProperty& corners = element.properties[element.index_list];
  if (corners.type != PlyType::int32 && corners.type != PlyType::uint32) return std::nullopt;
  if (!is_integer(*corners.count_type) || size_of(*corners.count_type) > 4) return std::nullopt;
  TriangleLayout layout;
  layout.count_bytes = size_of(*corners.count_type);
  layout.index_type = corners.type;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (i == element.label) {
      layout.label_offset = layout.record_bytes;
      layout.label_type = property.type;
    }
    if (i == element.index_list) {
      layout.list_offset = layout.record_bytes;
      layout.record_bytes += layout.count_bytes + 3 * size_of(corners.type);
    } else if (property.is_list()) {
      if (layout.six || !is_integer(*property.count_type)) return std::nullopt;
      layout.six = {layout.record_bytes, *property.count_type, property.type};
      layout.record_bytes += size_of(*property.count_type) + 6 * size_of(property.type);
    } else {
      layout.record_bytes += size_of(property.type);
    }
  }
  return layout;
}

template <std::endian Order>
std::size_t decode_triangles(const TriangleLayout& layout, const char* records,
                             std::uint64_t vertices, std::span<WideTriangle> out) {
  switch (layout.count_bytes) {
    case 1:
      return decode<std::uint8_t, Order>(layout, records, vertices, out);
    case 2:
      return decode<std::uint16_t, Order>(layout, records, vertices, out);
    default:
      return decode<std::uint32_t, Order>(layout, records, vertices, out);
  }
}

template std::size_t decode_triangles<std::endian::little>(const TriangleLayout&, const char*,
                                                           std::uint64_t, std::span<WideTriangle>);
template std::size_t decode_triangles<std::endian::big>(const TriangleLayout&, const char*,
                                                        std::uint64_t, std::span<WideTriangle>);

template <std::endian Order>
void decode_labels(const TriangleLayout& layout, const char* records, std::span<Label> out) {
  const char* bytes = records + layout.label_offset;
  for (Label& label : out) {
    label = load_label<Order>(layout.label_type, bytes);
    bytes += layout.record_bytes;
  }
}

template void decode_labels<std::endian::little>(const TriangleLayout&, const char*,
                                                 std::span<Label>);
template void decode_labels<std::endian::big>(const TriangleLayout&, const char*, std::span<Label>);

template <std::endian Order>
void decode_uvs(const TriangleLayout& layout, const char* records, std::span<CornerUvs> out) {
  const PlyType type = layout.six->type;
  const std::size_t size = size_of(type);
  const char* values = records + layout.six->offset + size_of(layout.six->count_type);
  for (CornerUvs& uvs : out) {
    for (std::size_t i = 0; i < 6; ++i) {
      const float value = type == PlyType::float32
                              ? load_ply<float, Order>(values + i * size)
                              : static_cast<float>(load_real<Order>(type, values + i * size));
      uvs[i / 2][i % 2] = std::isfinite(value) ? value : 0;
    }
    values += layout.record_bytes;
  }
}

template void decode_uvs<std::endian::little>(const TriangleLayout&, const char*,
                                              std::span<CornerUvs>);
template void decode_uvs<std::endian::big>(const TriangleLayout&, const char*,
                                           std::span<CornerUvs>);

}  // namespace meshfarm
