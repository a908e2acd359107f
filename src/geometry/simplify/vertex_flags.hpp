// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// What a vertex may do, one byte each. A merged vertex inherits all flags except k_fixed.
enum VertexFlag : std::uint8_t {
  k_fixed = 1,     // neither moves nor goes
  k_border = 2,    // on an edge that has one triangle
  k_seam = 4,      // SimplifyOptions::seam
  k_crease = 8,    // on an edge sharper than LineOptions::crease_angle
  k_corner = 16,   // where creases meet or end
  k_complex = 32,  // its triangles are not one consistently oriented fan
  k_thin = 64,     // another sheet is near
  k_opened = 128   // of a sheet that was a closed piece: SimplifyOptions::opened
};

/// Whether a collapse at a vertex with these flags may remove an odd number of triangles. Elsewhere
/// they go in pairs.
inline bool may_lose_one(std::uint8_t flags) {
  return (flags & k_fixed) == 0 && (flags & (k_border | k_complex)) != 0;
}

/// Whether the vertex is on a border, and no line meets it there.
inline bool is_on_plain_border(std::uint8_t flags) {
  return (flags & ~k_opened) == k_border;
}

/// Passes leave the edges at these vertices alone.
constexpr std::uint8_t k_still = k_fixed | k_complex;

}  // namespace meshfarm
