// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A part, kind "PART", version 2; the payload of a sealed file:
//   vertex format u8 (io/staged_positions.hpp) | boundary vertices u32 | vertices u64 | triangles
//   u64 | positions, 3 numbers a vertex, boundary vertices first | appearances, 4 x u16 a vertex |
//   labels, u32 a triangle | texture coordinates, 6 x f32 a triangle |
//   packed triangles (io/packed_triangles.hpp), up to the end
// Version 1 had triangles of 3 x u32.
#include <utility>

#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_part_kind = {'P', 'A', 'R', 'T'};
constexpr std::uint32_t k_part_version = 2;

}  // namespace

std::string encode_part(const Part& part) {
  ByteWriter out;
  const VertexFormat format{part.positions, !part.mesh.appearances.empty(),
                            part.mesh.columns.set()};
  put_vertex_format(out, format);
  out.put(part.boundary_vertices);
  out.put(static_cast<std::uint64_t>(part.mesh.positions.size()));
  out.put(static_cast<std::uint64_t>(part.mesh.triangles.size()));
  put_vertices(out, VertexView(part.mesh), format);
  put_columns(out, part.mesh.columns);
  out.put_array(std::span(std::string_view(pack_triangles(part.mesh.triangles))));
  return seal(k_part_kind, k_part_version, out.bytes());
}

Part decode_part(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_part_kind, k_part_version, what), what);
  Part part;
  const VertexFormat format = get_vertex_format(in);
  part.positions = format.positions;
  part.boundary_vertices = in.get<std::uint32_t>();
  const auto vertices = in.get<std::uint64_t>();
  const auto triangles = in.get<std::uint64_t>();
  if (part.boundary_vertices > vertices) in.fail("more boundary vertices than vertices");
  get_vertices(in, vertices, format, part.mesh.positions, part.mesh.appearances);
  get_columns(in, triangles, format.columns, part.mesh.columns);
  auto unpacked = unpack_triangles(in.take(in.remaining()));
  if (!unpacked || unpacked->size() != triangles) in.fail("other triangles than promised");
  part.mesh.triangles = std::move(*unpacked);
  check_corners(in, part.mesh.positions.size(), part.mesh.triangles);
  return part;
}

}  // namespace meshfarm
