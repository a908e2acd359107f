// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A slab, kind "SLAB", version 2; the payload of a sealed file:
//   vertex format u8 (io/staged_positions.hpp) | vertices u64 | boundary vertices u64 | triangles
//   u64 | vertices apart u64 | positions, 3 numbers a vertex | appearances, 4 x u16 a vertex |
//   boundary vertices u32, ascending | vertices apart, each vertex u32 and sheet u32, ascending |
//   labels, u32 a triangle, and texture coordinates, 6 x f32, if the format says so |
//   packed triangles (io/packed_triangles.hpp), up to the end
// Version 1 had no vertices apart.
#include <utility>

#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_slab_kind = {'S', 'L', 'A', 'B'};
constexpr std::uint32_t k_slab_version = 2;

/// They must be ascending, and those of one sheet at one point.
void check_apart(const ByteReader& in, const MeshShare& slab) {
  const std::vector<ApartVertex>& apart = slab.apart;
  std::vector<std::uint32_t> place_of_sheet(apart.size(), UINT32_MAX);
  for (std::size_t i = 0; i < apart.size(); ++i) {
    const auto [place, sheet] = apart[i];
    const bool ascends = i == 0 || apart[i - 1].place < place;
    if (!ascends || place >= slab.positions.size() || sheet >= apart.size()) {
      in.fail("impossible vertices apart");
    }
    if (place_of_sheet[sheet] == UINT32_MAX) place_of_sheet[sheet] = place;
    if (!(slab.positions[place_of_sheet[sheet]] == slab.positions[place])) {
      in.fail("a sheet of vertices at several points");
    }
  }
}

}  // namespace

std::string encode_slab(const MeshShare& slab) {
  constexpr std::uint64_t k_usual_triangle = 8;  // bytes
  ByteWriter out;
  const VertexFormat format{slab.type, !slab.appearances.empty(), slab.columns.set()};
  out.reserve(64 + format.bytes() * slab.positions.size() +
              sizeof(std::uint32_t) * slab.boundary.size() +
              (format.columns.bytes() + k_usual_triangle) * slab.triangles.size());
  put_vertex_format(out, format);
  out.put(static_cast<std::uint64_t>(slab.positions.size()));
  out.put(static_cast<std::uint64_t>(slab.boundary.size()));
  out.put(static_cast<std::uint64_t>(slab.triangles.size()));
  out.put(static_cast<std::uint64_t>(slab.apart.size()));
  put_vertices(out, {slab.positions, slab.appearances}, format);
  out.put_array(std::span<const std::uint32_t>(slab.boundary));
  out.put_array(std::span<const ApartVertex>(slab.apart));
  put_columns(out, slab.columns);
  out.put_array(std::span(std::string_view(pack_triangles(slab.triangles))));
  return seal(k_slab_kind, k_slab_version, out.bytes());
}

MeshShare decode_slab(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_slab_kind, k_slab_version, what), what);
  MeshShare slab;
  const VertexFormat format = get_vertex_format(in);
  slab.type = format.positions;
  const auto vertices = in.get<std::uint64_t>();
  const auto boundary = in.get<std::uint64_t>();
  const auto triangles = in.get<std::uint64_t>();
  const auto apart = in.get<std::uint64_t>();
  get_vertices(in, vertices, format, slab.positions, slab.appearances);
  slab.boundary = in.get_array<std::uint32_t>(boundary);
  for (std::size_t i = 0; i < slab.boundary.size(); ++i) {
    const bool ascends = i == 0 || slab.boundary[i - 1] < slab.boundary[i];
    if (!ascends || slab.boundary[i] >= vertices) in.fail("impossible boundary vertices");
  }
  slab.apart = in.get_array<ApartVertex>(apart);
  check_apart(in, slab);
  get_columns(in, triangles, format.columns, slab.columns);
  auto unpacked = unpack_triangles(in.take(in.remaining()));
  if (!unpacked || unpacked->size() != triangles) in.fail("other triangles than promised");
  slab.triangles = std::move(*unpacked);
  check_corners(in, slab.positions.size(), slab.triangles);
  return slab;
}

}  // namespace meshfarm
