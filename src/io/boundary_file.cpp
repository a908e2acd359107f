// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The boundary side file, kind "BNDY", version 1; the payload of a sealed file:
//   triangles u64 | triangles x 3 x (part u32 | local index u32)
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'B', 'N', 'D', 'Y'};
constexpr std::uint32_t k_version = 1;

}  // namespace

std::string encode_boundary(const std::vector<BoundaryTriangle>& triangles) {
  ByteWriter out;
  out.put(static_cast<std::uint64_t>(triangles.size()));
  out.put_array(std::span<const BoundaryTriangle>(triangles));
  return seal(k_kind, k_version, out.bytes());
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  const auto count = in.get<std::uint64_t>();
  auto triangles = in.get_array<BoundaryTriangle>(count);
  in.expect_end();
  return triangles;
}

}  // namespace meshfarm
