// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/flat.hpp"

namespace meshfarm {

inline constexpr std::uint32_t k_no_owner = 0xffffffff;

/// Which triangle each texel of a square picture has its colour from.
struct TexelOwners {
  std::uint32_t side = 0;
  std::vector<std::uint32_t> triangles;  // row by row from below; k_no_owner where none is near
  std::uint64_t covered = 0;             // texels that triangles touch

  std::uint32_t at(std::uint32_t x, std::uint32_t y) const {
    return triangles[std::size_t{y} * side + x];
  }
};

/// The point of the triangle nearest to p.
Flat nearest_point(Flat p, const FlatTriangle& triangle);

struct OwnerOptions {
  std::uint32_t side = 0;
  std::uint32_t margin = 0;  // texels round the triangles that are theirs, too
  unsigned threads = 0;
};

/// A texel is of the triangle that its centre lies in, else of the nearest one.
TexelOwners texel_owners(std::span<const FlatTriangle> triangles, const OwnerOptions& options);

}  // namespace meshfarm
