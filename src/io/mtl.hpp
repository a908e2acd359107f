// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace meshfarm {

/// A picture of a material, and its placement on the surface.
struct MtlMap {
  std::string file;                   // may be empty
  std::array<double, 2> scale{1, 1};  // u becomes u scale + offset
  std::array<double, 2> offset{0, 0};
  bool is_clamped = false;

  bool lies_as(const MtlMap& other) const {
    return scale == other.scale && offset == other.offset && is_clamped == other.is_clamped;
  }
};

/// A material of an OBJ's library, reduced to what colours it.
struct MtlMaterial {
  std::string name;
  std::array<double, 3> colour{1, 1, 1};  // Kd, as sRGB from 0 to 1
  double alpha = 1;                       // d, or 1 - Tr
  MtlMap map;                             // map_Kd
  MtlMap normals;                         // norm, map_Bump, or bump
  MtlMap emission;                        // map_Ke
  std::vector<std::string> other_maps;    // the words of those that are not read: "map_Ks"
};

/// The materials of a library, in its order. Malformed statements are ignored.
std::vector<MtlMaterial> parse_mtl(std::string_view text);

}  // namespace meshfarm
