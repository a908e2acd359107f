// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <string>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/util/errors.hpp>

#include "geometry/texture/atlas_charts.hpp"
#include "geometry/texture/atlas_flat.hpp"
#include "geometry/texture/atlas_pack.hpp"

namespace meshfarm {
namespace {

/// Expected share of the picture that charts cover.
constexpr double k_usual_coverage = 0.5;
/// A chart with fewer texels than this times the margin squared costs more in margins than it is
/// worth.
constexpr double k_tiny_texels = 16;

using PointOnPicture = std::array<float, 2>;

PointOnPicture on_picture(Flat texel, std::uint32_t side) {
  const auto share = [side](double x) {
    return static_cast<float>(std::clamp(x / side, 0.0, 1.0));
  };
  return {share(texel.x), share(texel.y)};
}

double tiny_area(double area, const AtlasOptions& options) {
  const double side = options.texture_size;
  const double texels = k_tiny_texels * options.margin_texels * options.margin_texels;
  return area * texels / (k_usual_coverage * side * side);
}

void put_charts(std::span<const FlatChart> charts, const Packing& packing, std::uint32_t side,
                Atlas& atlas) {
  double texels = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const FlatChart& chart = charts[c];
    for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
      const std::uint32_t t = chart.triangles[i];
      atlas.chart_of[t] = static_cast<std::uint32_t>(c);
      for (std::size_t k = 0; k < 3; ++k) {
        const Flat at = packing.placed(chart.corners[i][k], packing.places[c]);
        atlas.uvs[t][k] = on_picture(at, side);
      }
      texels += std::max(0.0, doubled_area(chart.corners[i]) / 2);
    }
  }
  texels *= packing.scale * packing.scale;
  atlas.coverage = texels / (static_cast<double>(side) * side);
}

/// Maps a triangle without a chart to a point of a triangle that it shares a vertex with, or of
/// any.
void put_rest(const Mesh& mesh, Atlas& atlas) {
  if (std::find(atlas.chart_of.begin(), atlas.chart_of.end(), k_no_chart) == atlas.chart_of.end()) {
    return;
  }
  std::vector<std::uint8_t> is_known(mesh.positions.size(), 0);
  std::vector<PointOnPicture> known(mesh.positions.size());
  PointOnPicture any{0.5F, 0.5F};
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
    if (atlas.chart_of[t] == k_no_chart) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      is_known[mesh.triangles[t][k]] = 1;
      known[mesh.triangles[t][k]] = atlas.uvs[t][k];
    }
    any = atlas.uvs[t][0];
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (atlas.chart_of[t] != k_no_chart) continue;
    PointOnPicture at = any;
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (is_known[v] != 0) at = known[v];
    }
    atlas.uvs[t] = {at, at, at};
  }
}

}  // namespace

Atlas make_atlas(const Mesh& mesh, const AtlasOptions& options) {
  if (options.texture_size < 1 || options.texture_size > k_most_atlas_side) {
    throw UsageError("a texture of " + std::to_string(options.texture_size) +
                     " texels a side: 1 to " + std::to_string(k_most_atlas_side) + " are possible");
  }
  Atlas atlas;
  atlas.uvs.resize(mesh.triangles.size());
  atlas.chart_of.assign(mesh.triangles.size(), k_no_chart);
  atlas.margin_texels = options.margin_texels;
  const ChartSurface surface = chart_surface(mesh, options.threads);
  const double area = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
  if (area > 0) {
    const Charts charts = make_charts(surface, tiny_area(area, options));
    const std::vector<FlatChart> flat = flatten_charts(surface, charts, options.threads);
    std::vector<PackShape> shapes;
    shapes.reserve(flat.size());
    for (const FlatChart& chart : flat) shapes.push_back({chart.size, chart.outline});
    const Packing packing =
        pack_shapes(shapes, {.side = options.texture_size,
                             .margin = std::min(options.margin_texels, options.texture_size / 4),
                             .area = area});
    atlas.charts = static_cast<std::uint32_t>(flat.size());
    atlas.margin_texels = packing.margin;
    atlas.texels_per_unit = packing.scale;
    put_charts(flat, packing, options.texture_size, atlas);
  }
  put_rest(mesh, atlas);
  return atlas;
}

}  // namespace meshfarm
