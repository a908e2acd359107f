// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

namespace meshfarm::simplify_test {

/// The mesh with uv_at(position, centre of the triangle) at each corner.
template <typename UvAt>
Mesh mapped(Mesh mesh, const UvAt& uv_at) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 pa = mesh.positions[a];
    const Vec3 pb = mesh.positions[b];
    const Vec3 pc = mesh.positions[c];
    const Vec3 centre = (pa + pb + pc) * (1.0 / 3);
    mesh.columns.uvs.push_back({uv_at(pa, centre), uv_at(pb, centre), uv_at(pc, centre)});
  }
  return mesh;
}

inline Uv uv(double u, double v) {
  return {static_cast<float>(u), static_cast<float>(v)};
}

inline double area_of(const CornerUvs& t) {
  const auto side = [&](std::size_t k, std::size_t i) { return double{t[k][i]} - t[0][i]; };
  return side(1, 0) * side(2, 1) - side(1, 1) * side(2, 0);
}

inline std::size_t count_turned(const Mesh& mesh) {
  return static_cast<std::size_t>(
      std::count_if(mesh.columns.uvs.begin(), mesh.columns.uvs.end(),
                    [](const CornerUvs& t) { return area_of(t) <= 0; }));
}

/// A square cut into side x side charts, each somewhere else on the picture.
inline Mesh chart_grid(Mesh mesh, int side) {
  return mapped(std::move(mesh), [side](Vec3 p, Vec3 centre) {
    const double column = std::floor(centre.x * side);
    const double row = std::floor(centre.y * side);
    const double x = p.x * side - column;
    const double y = p.y * side - row;
    const bool turned = std::fmod(column + row, 2) != 0;
    return uv(1.25 * (side - column) + (turned ? y : x), 1.25 * row + (turned ? -x : y));
  });
}

/// The unit sphere as a cube map.
inline Mesh cube_map(int times) {
  Mesh mesh{{}, {}};
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {i % 2 != 0 ? 1.0 : -1.0, i / 2 % 2 != 0 ? 1.0 : -1.0, i / 4 != 0 ? 1.0 : -1.0});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh = quartered(std::move(mesh), times);
  mesh = mapped(std::move(mesh), [](Vec3 p, Vec3 c) {
    const double x = std::abs(c.x);
    const double y = std::abs(c.y);
    const double z = std::abs(c.z);
    if (x > y && x > z) return uv(p.y * c.x / x, p.z + (c.x > 0 ? 3 : 6));
    if (y > z) return uv(p.z * c.y / y + 3, p.x + (c.y > 0 ? 3 : 6));
    return uv(p.x * c.z / z + 6, p.y + (c.z > 0 ? 3 : 6));
  });
  for (Vec3& p : mesh.positions) p = p * (1 / length(p));
  return mesh;
}

/// A tube along z without ends, unrolled: one chart whose sides meet at angle 0.
inline Mesh unrolled_tube(std::uint32_t around, std::uint32_t along) {
  Mesh mesh = grid(around, along, [](double, double) { return 0.0; });
  mesh = mapped(std::move(mesh), [](Vec3 p, Vec3) { return uv(p.x, p.y); });
  const std::uint32_t width = around + 1;
  for (Vec3& p : mesh.positions) {
    const double angle = 2 * std::numbers::pi * p.x;
    p = {std::cos(angle), std::sin(angle), 2 * p.y};
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (v % width == around) v -= around;
    }
  }
  // Drops the vertices that are no longer used.
  Mesh packed{{}, std::move(mesh.triangles), {}, std::move(mesh.columns)};
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (v % width != around) packed.positions.push_back(mesh.positions[v]);
  }
  for (Triangle& t : packed.triangles) {
    for (std::uint32_t& v : t) v -= v / width;
  }
  return packed;
}

/// One chart, open along a slit from the side to the middle of the square.
inline Mesh dart(Mesh mesh) {
  return mapped(std::move(mesh), [](Vec3 p, Vec3 centre) {
    const double open = centre.y > 0.5 && p.x < 0.5 ? 0.2 * (0.5 - p.x) : 0;
    return uv(p.x, p.y + open);
  });
}

inline Mesh reduced(const Mesh& mesh, std::uint64_t triangles, SimplifyOptions options = {}) {
  Simplifier simplifier(mesh, options);
  simplifier.reduce({.triangles = triangles});
  return simplifier.mesh();
}

using Place = std::array<double, 3>;
inline Place place_of(Vec3 p) {
  return {p.x, p.y, p.z};
}

/// An edge at a seam or border, its lower vertex first; and the texture coordinates of both sides
/// at each end.
struct SeamEdge {
  std::array<Place, 2> ends;
  std::array<std::set<Uv>, 2> at_ends;
};

inline std::vector<SeamEdge> seams_of(const Mesh& mesh) {
  using Side = std::array<Uv, 2>;
  std::map<std::array<std::uint32_t, 2>, std::vector<Side>> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = (k + 1) % 3;
      const std::uint32_t a = mesh.triangles[i][k];
      const std::uint32_t b = mesh.triangles[i][n];
      const Uv at_a = mesh.columns.uvs[i][k];
      const Uv at_b = mesh.columns.uvs[i][n];
      if (a < b) edges[{a, b}].push_back({at_a, at_b});
      if (b < a) edges[{b, a}].push_back({at_b, at_a});
    }
  }
  std::vector<SeamEdge> seams;
  for (const auto& [edge, sides] : edges) {
    if (sides.size() == 2 && sides[0] == sides[1]) continue;
    SeamEdge seam;
    for (std::size_t e = 0; e < 2; ++e) {
      seam.ends[e] = place_of(mesh.positions[edge[e]]);
      for (const Side& s : sides) seam.at_ends[e].insert(s[e]);
    }
    seams.push_back(seam);
  }
  return seams;
}

/// The number of ends of seams and borders of the result that the input does not have, or with
/// other texture coordinates.
inline std::size_t strange_ends(const Mesh& input, const Mesh& result) {
  std::map<Place, std::set<Uv>> known;
  for (const SeamEdge& seam : seams_of(input)) {
    for (std::size_t e = 0; e < 2; ++e) {
      known[seam.ends[e]].insert(seam.at_ends[e].begin(), seam.at_ends[e].end());
    }
  }
  std::size_t strange = 0;
  for (const SeamEdge& seam : seams_of(result)) {
    for (std::size_t e = 0; e < 2; ++e) {
      const auto at = known.find(seam.ends[e]);
      const bool is_known =
          at != known.end() && std::includes(at->second.begin(), at->second.end(),
                                             seam.at_ends[e].begin(), seam.at_ends[e].end());
      strange += is_known ? 0 : 1;
    }
  }
  return strange;
}

}  // namespace meshfarm::simplify_test
