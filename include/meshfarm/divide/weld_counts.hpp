// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace meshfarm {

/// Counts of coincidences among the vertices of one share.
struct WeldCounts {
  std::uint64_t coincident_vertices = 0;  // at the place of an earlier one, merged or not
  std::uint64_t dropped_degenerate = 0;   // triangles
  std::uint64_t coincident_corners = 0;   // triangles with two corners at one place
};

}  // namespace meshfarm
