// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/texture/atlas_charts.hpp"
#include "geometry/texture/flat.hpp"

namespace meshfarm {

/// A flattened chart: its area equals that of the surface.
struct FlatChart {
  std::vector<std::uint32_t> triangles;
  std::vector<FlatTriangle> corners;         // of each triangle; no two overlap
  std::vector<std::array<Flat, 2>> outline;  // sides that belong to only one triangle
  Flat size;                                 // of its box, which starts at (0, 0)
};

/// Projects each chart along its axis, and turns it to the smallest box. A chart that would overlap
/// itself is divided. Charts without any area are left out.
std::vector<FlatChart> flatten_charts(const ChartSurface& surface, const Charts& charts,
                                      unsigned threads);

}  // namespace meshfarm
