// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A part, kind "PART", version 1; the payload of a sealed file:
//   position type u8 (4 float32, 8 float64) | boundary vertices u32 | vertices u64 | triangles u64
//   | positions, 3 numbers a vertex, boundary vertices first | triangles, 3 x u32
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/part_mesh.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'P', 'A', 'R', 'T'};
constexpr std::uint32_t k_version = 1;

}  // namespace

std::string encode_part(const Part& part) {
  ByteWriter out;
  out.put(part.positions);
  out.put(part.boundary_vertices);
  out.put(static_cast<std::uint64_t>(part.mesh.positions.size()));
  out.put(static_cast<std::uint64_t>(part.mesh.triangles.size()));
  put_mesh(out, part.mesh, part.positions);
  return seal(k_kind, k_version, out.bytes());
}

Part decode_part(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  Part part;
  part.positions = get_position_type(in);
  part.boundary_vertices = in.get<std::uint32_t>();
  const auto vertices = in.get<std::uint64_t>();
  const auto triangles = in.get<std::uint64_t>();
  if (part.boundary_vertices > vertices) in.fail("more boundary vertices than vertices");
  part.mesh = get_mesh(in, vertices, triangles, part.positions);
  in.expect_end();
  return part;
}

}  // namespace meshfarm
