// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A slab, kind "SLAB", version 1; the payload of a sealed file:
//   position type u8 (4 float32, 8 float64) | vertices u64 | boundary vertices u64 | triangles u64
//   | positions, 3 numbers a vertex | boundary vertices u32, ascending
//   | packed triangles (io/packed_triangles.hpp), up to the end
#include <utility>

#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'S', 'L', 'A', 'B'};
constexpr std::uint32_t k_version = 1;

}  // namespace

std::string encode_slab(const MeshShare& slab) {
  constexpr std::uint64_t k_usual_triangle = 8;  // bytes
  ByteWriter out;
  out.reserve(64 + 3 * static_cast<std::uint64_t>(slab.type) * slab.positions.size() +
              sizeof(std::uint32_t) * slab.boundary.size() +
              k_usual_triangle * slab.triangles.size());
  out.put(slab.type);
  out.put(static_cast<std::uint64_t>(slab.positions.size()));
  out.put(static_cast<std::uint64_t>(slab.boundary.size()));
  out.put(static_cast<std::uint64_t>(slab.triangles.size()));
  put_positions(out, slab.positions, slab.type);
  out.put_array(std::span<const std::uint32_t>(slab.boundary));
  TrianglePacker packer;
  for (const Triangle& t : slab.triangles) out.put_array(std::span(packer.pack(t)));
  return seal(k_kind, k_version, out.bytes());
}

MeshShare decode_slab(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  MeshShare slab;
  slab.type = get_position_type(in);
  const auto vertices = in.get<std::uint64_t>();
  const auto boundary = in.get<std::uint64_t>();
  const auto triangles = in.get<std::uint64_t>();
  slab.positions = get_positions(in, vertices, slab.type);
  slab.boundary = in.get_array<std::uint32_t>(boundary);
  for (std::size_t i = 0; i < slab.boundary.size(); ++i) {
    const bool ascends = i == 0 || slab.boundary[i - 1] < slab.boundary[i];
    if (!ascends || slab.boundary[i] >= vertices) in.fail("impossible boundary vertices");
  }
  auto unpacked = unpack_triangles(in.take(in.remaining()));
  if (!unpacked || unpacked->size() != triangles) in.fail("other triangles than promised");
  slab.triangles = std::move(*unpacked);
  check_corners(in, slab.positions.size(), slab.triangles);
  return slab;
}

}  // namespace meshfarm
