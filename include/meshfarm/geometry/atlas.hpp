// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

struct AtlasOptions {
  std::uint32_t texture_size = 2048;  // texels per side of the picture: 1 to k_most_atlas_side
  std::uint32_t margin_texels = 4;    // round each chart; two charts are twice as far apart
  unsigned threads = 0;               // 0: one per core
};

inline constexpr std::uint32_t k_most_atlas_side = 16'384;

/// Marks a triangle without a chart: neither it nor its neighbours have an area.
inline constexpr std::uint32_t k_no_chart = 0xffffffff;

/// Where the triangles of a mesh lie on a picture.
struct Atlas {
  /// Of each triangle's corners: from the lower left corner of the picture, v upwards, 0 to 1.
  std::vector<std::array<std::array<float, 2>, 3>> uvs;
  std::vector<std::uint32_t> chart_of;  // of each triangle, or k_no_chart
  std::uint32_t charts = 0;
  /// The free margin round each chart. Less than requested if there are too many charts for the
  /// picture; 0 if several charts share texels.
  std::uint32_t margin_texels = 0;
  double texels_per_unit = 0;  // of length: the same for all charts, averaged over a chart
  double coverage = 0;         // the share of the picture that triangles cover
};

/// Cuts the surface into charts, each the projection of a connected region along its mean normal,
/// and packs them into the picture so that no two triangles overlap and equal areas have equal
/// numbers of texels. Accepts any mesh: what cannot be joined becomes separate charts, and a
/// triangle without area is mapped to a point. The result does not depend on the threads. Memory:
/// about 250 bytes per triangle. The mesh must have finite coordinates. Throws UsageError for a
/// texture size that is out of range.
Atlas make_atlas(const Mesh& mesh, const AtlasOptions& options);

}  // namespace meshfarm
