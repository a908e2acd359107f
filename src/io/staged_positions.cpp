// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "io/staged_positions.hpp"

#include <array>
#include <cstring>
#include <limits>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::uint8_t k_appearances = 16;
constexpr std::uint8_t k_labels = 32;
constexpr std::uint8_t k_uvs = 64;

}  // namespace

void put_positions(ByteWriter& out, std::span<const Vec3> points, PositionType positions) {
  if (positions == PositionType::float64) return out.put_array(points);
  for (const Vec3& p : points) {
    out.put(std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y),
                                 static_cast<float>(p.z)});
  }
}

std::vector<Vec3> get_positions(ByteReader& in, std::uint64_t count, PositionType positions) {
  std::vector<Vec3> points;
  if (positions == PositionType::float64) {
    points = in.get_array<Vec3>(count);
  } else {
    std::array<float, 3> p{};
    if (count > in.remaining() / sizeof p) in.fail("positions run past the end");
    const std::string_view raw = in.take(count * sizeof p);
    points.reserve(count);
    for (std::size_t at = 0; at < raw.size(); at += sizeof p) {
      std::memcpy(p.data(), raw.data() + at, sizeof p);
      points.push_back({p[0], p[1], p[2]});
    }
  }
  for (const Vec3& p : points) {
    if (!is_finite(p)) in.fail("a coordinate is not finite");
  }
  return points;
}

void check_corners(const ByteReader& in, std::size_t vertices,
                   std::span<const Triangle> triangles) {
  if (vertices > std::numeric_limits<std::uint32_t>::max()) in.fail("too many vertices for a part");
  for (const Triangle& t : triangles) {
    if (t[0] >= vertices || t[1] >= vertices || t[2] >= vertices) {
      in.fail("a triangle uses a vertex that is not there");
    }
  }
}

PositionType get_position_type(ByteReader& in) {
  const auto type = in.get<PositionType>();
  if (type != PositionType::float32 && type != PositionType::float64) {
    in.fail("unknown kind of positions");
  }
  return type;
}

std::size_t VertexFormat::bytes() const {
  return 3 * static_cast<std::size_t>(positions) + (appearances ? sizeof(Appearance) : 0);
}

void put_vertex_format(ByteWriter& out, VertexFormat format) {
  const int byte = static_cast<int>(format.positions) + (format.appearances ? k_appearances : 0) +
                   (format.columns.labels ? k_labels : 0) + (format.columns.uvs ? k_uvs : 0);
  out.put(static_cast<std::uint8_t>(byte));
}

std::optional<VertexFormat> vertex_format_of(std::uint8_t byte) {
  VertexFormat format;
  format.appearances = (byte & k_appearances) != 0;
  format.columns = {(byte & k_labels) != 0, (byte & k_uvs) != 0};
  format.positions = static_cast<PositionType>(byte & ~(k_appearances | k_labels | k_uvs));
  if (format.positions != PositionType::float32 && format.positions != PositionType::float64) {
    return std::nullopt;
  }
  return format;
}

VertexFormat get_vertex_format(ByteReader& in) {
  const std::optional<VertexFormat> format = vertex_format_of(in.get<std::uint8_t>());
  if (!format) in.fail("unknown kind of positions");
  return *format;
}

void put_columns(ByteWriter& out, const TriangleColumnsView& columns) {
  out.put_array(columns.labels);
  out.put_array(columns.uvs);
}

void get_columns(ByteReader& in, std::uint64_t triangles, const ColumnSet& set,
                 TriangleColumns& columns) {
  TriangleColumns more;
  if (set.labels) more.labels = in.get_array<Label>(triangles);
  if (set.uvs) more.uvs = in.get_array<CornerUvs>(triangles);
  for (const CornerUvs& corners : more.uvs) {
    for (const auto& [u, v] : corners) {
      if (!std::isfinite(u) || !std::isfinite(v)) in.fail("impossible texture coordinates");
    }
  }
  columns.append(more);
}

void put_vertices(ByteWriter& out, const VertexView& vertices, VertexFormat format) {
  put_positions(out, vertices.positions, format.positions);
  if (!format.appearances) return;
  if (vertices.appearances.size() != vertices.size()) {
    throw Error("vertices without the appearances that their file promises");
  }
  out.put_array(vertices.appearances);
}

void get_vertices(ByteReader& in, std::uint64_t count, VertexFormat format,
                  std::vector<Vec3>& positions, std::vector<Appearance>& appearances) {
  const std::vector<Vec3> more = get_positions(in, count, format.positions);
  positions.insert(positions.end(), more.begin(), more.end());
  if (!format.appearances) return;
  const auto beside = in.get_array<Appearance>(count);
  appearances.insert(appearances.end(), beside.begin(), beside.end());
}

}  // namespace meshfarm
