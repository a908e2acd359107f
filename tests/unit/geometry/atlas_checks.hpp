// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/atlas.hpp>

namespace meshfarm::test {

struct TexelPoint {
  double x = 0;
  double y = 0;
};

/// A triangle of an atlas in texels, y upwards.
inline std::array<TexelPoint, 3> texel_corners(const Atlas& atlas, std::size_t t, double side) {
  std::array<TexelPoint, 3> made;
  for (std::size_t k = 0; k < 3; ++k) {
    made[k] = {static_cast<double>(atlas.uvs[t][k][0]) * side,
               static_cast<double>(atlas.uvs[t][k][1]) * side};
  }
  return made;
}

inline double texel_area(const std::array<TexelPoint, 3>& t) {
  return ((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x)) / 2;
}

/// The least distance to the line of a side; positive inside.
inline double depth_inside(const std::array<TexelPoint, 3>& t, double x, double y) {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const TexelPoint a = t[k], b = t[(k + 1) % 3];
    const double size = std::hypot(b.x - a.x, b.y - a.y);
    least = std::min(least, ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / size);
  }
  return least;
}

/// Calls take(x, y) for the texels whose centres lie in a triangle, deeper than rounding.
template <typename Take>
void for_texels(const std::array<TexelPoint, 3>& t, std::uint32_t side, const Take& take) {
  if (!(texel_area(t) > 0)) return;
  const auto texel = [side](double x) {
    return static_cast<std::uint32_t>(std::clamp(x, 0.0, side - 1.0));
  };
  const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
  for (std::uint32_t y = texel(y0); y <= texel(y1); ++y) {
    for (std::uint32_t x = texel(x0); x <= texel(x1); ++x) {
      if (depth_inside(t, x + 0.5, y + 0.5) > 1e-3) take(x, y);
    }
  }
}

/// The triangle at each texel's centre, row by row from below; k_no_chart where there is none.
/// Checks that no texel has two.
inline std::vector<std::uint32_t> owners_of(const Atlas& atlas, std::uint32_t side) {
  std::vector<std::uint32_t> owners(std::size_t{side} * side, k_no_chart);
  std::size_t twice = 0;
  for (std::size_t t = 0; t < atlas.uvs.size(); ++t) {
    for_texels(texel_corners(atlas, t, side), side, [&](std::uint32_t x, std::uint32_t y) {
      std::uint32_t& owner = owners[std::size_t{y} * side + x];
      if (owner != k_no_chart) ++twice;
      owner = static_cast<std::uint32_t>(t);
    });
  }
  CHECK(twice == 0);
  return owners;
}

/// Checks that charts are at least two margins apart, and at least one margin from the rim.
inline void check_margins(const Atlas& atlas, std::uint32_t side) {
  const std::vector<std::uint32_t> owners = owners_of(atlas, side);
  const auto chart_at = [&](std::uint32_t x, std::uint32_t y) {
    const std::uint32_t owner = owners[std::size_t{y} * side + x];
    return owner == k_no_chart ? k_no_chart : atlas.chart_of[owner];
  };
  // Whatever is near a texel surrounded by its own chart is nearer to one of its neighbours.
  const auto is_inner = [&](std::uint32_t x, std::uint32_t y, std::uint32_t chart) {
    return x > 0 && y > 0 && x + 1 < side && y + 1 < side && chart_at(x - 1, y) == chart &&
           chart_at(x + 1, y) == chart && chart_at(x, y - 1) == chart &&
           chart_at(x, y + 1) == chart;
  };
  const std::uint32_t margin = atlas.margin_texels;
  std::size_t near = 0, outside = 0;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t here = chart_at(x, y);
      if (here == k_no_chart) continue;
      if (std::min({x, y, side - 1 - x, side - 1 - y}) < margin) ++outside;
      if (is_inner(x, y, here)) continue;
      for (std::uint32_t j = y; j < std::min(side, y + 2 * margin); ++j) {
        const std::uint32_t from = x - std::min(x, 2 * margin - 1);
        for (std::uint32_t i = from; i < std::min(side, x + 2 * margin); ++i) {
          const std::uint32_t there = chart_at(i, j);
          if (there != k_no_chart && there != here) ++near;
        }
      }
    }
  }
  CHECK(near == 0);
  CHECK(outside == 0);
}

/// Makes an atlas, and checks everything that is promised of one with a margin.
inline Atlas checked_atlas(const Mesh& mesh, const AtlasOptions& options) {
  Atlas atlas = make_atlas(mesh, options);
  REQUIRE(atlas.uvs.size() == mesh.triangles.size());
  REQUIRE(atlas.chart_of.size() == mesh.triangles.size());
  for (std::size_t t = 0; t < atlas.uvs.size(); ++t) {
    REQUIRE((atlas.chart_of[t] < atlas.charts || atlas.chart_of[t] == k_no_chart));
    for (const auto& [u, v] : atlas.uvs[t]) {
      REQUIRE((u >= 0 && u <= 1));
      REQUIRE((v >= 0 && v <= 1));
    }
  }
  check_margins(atlas, options.texture_size);
  return atlas;
}

}  // namespace meshfarm::test
