// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace meshfarm {

/// A material of an OBJ's library, as far as it colours.
struct MtlMaterial {
  std::string name;
  std::array<double, 3> colour{1, 1, 1};  // Kd, as sRGB from 0 to 1
  double alpha = 1;                       // d, or 1 - Tr
  std::string map;                        // map_Kd: the picture's file; may be empty
  std::array<double, 2> scale{1, 1};      // of map_Kd: u becomes u scale + offset
  std::array<double, 2> offset{0, 0};
  bool is_clamped = false;
};

/// The materials of a library, in its order. What is malformed counts as not there.
std::vector<MtlMaterial> parse_mtl(std::string_view text);

}  // namespace meshfarm
