// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/geometry/vertex_normals.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bake_fill.hpp"
#include "geometry/bake_owners.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_tile = 32;  // texels a side that are asked for together
/// Beside a triangle lower than this, in texels, its plane tells nothing of the surface.
constexpr double k_least_height = 0.25;

using Corners = std::array<double, 3>;
using Texel = std::array<std::uint8_t, 3>;

/// The corners' shares in a point, which may lie outside.
std::optional<Corners> plane_shares(Flat p, const FlatTriangle& t) {
  const double all = doubled_area(t);
  const double longest = std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
  if (!(all > longest * k_least_height)) return {};
  const double of_b = cross(p - t[0], t[2] - t[0]) / all;
  const double of_c = cross(t[1] - t[0], p - t[0]) / all;
  return Corners{1 - of_b - of_c, of_b, of_c};
}

/// The corners' shares in the triangle's nearest point.
Corners inner_shares(Flat p, const FlatTriangle& t) {
  return nearest_shares({p.x, p.y, 0}, {t[0].x, t[0].y, 0}, {t[1].x, t[1].y, 0},
                        {t[2].x, t[2].y, 0});
}

/// Points of one tile that wait for their colours.
struct Asked {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;
  std::vector<std::size_t> texels;  // of each `samples * samples` points: its index in the picture
};

class Baker {
 public:
  Baker(const Mesh& mesh, std::span<const std::array<std::array<float, 2>, 3>> uvs,
        const BakeOptions& options, const ColoursAt& colours_at)
      : mesh_(mesh),
        options_(options),
        colours_at_(colours_at),
        samples_(std::clamp(options.samples, 1U, 16U)),
        corners_(uvs.size()),
        triangles_(mesh.triangles),
        normals_(vertex_normals(mesh)) {
    for (std::size_t t = 0; t < uvs.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double side = options.texture_size;
        corners_[t][k] = {static_cast<double>(uvs[t][k][0]) * side,
                          static_cast<double>(uvs[t][k][1]) * side};
      }
      if (doubled_area(corners_[t]) >= 0) continue;
      std::swap(corners_[t][1], corners_[t][2]);
      std::swap(triangles_[t][1], triangles_[t][2]);
    }
  }

  BakedPicture run() {
    const std::uint32_t side = options_.texture_size;
    owners_ = texel_owners(
        corners_, {.side = side, .margin = options_.margin_texels, .threads = options_.threads});
    texels_.resize(owners_.triangles.size());
    is_set_.resize(owners_.triangles.size());
    const std::uint64_t tiles = (side + k_tile - 1) / k_tile;
    parallel_for(tiles * tiles, options_.threads, [&](std::uint64_t tile) {
      paint_tile(static_cast<std::uint32_t>(tile % tiles),
                 static_cast<std::uint32_t>(tile / tiles));
    });
    fill_texels(texels_, is_set_, side, options_.threads);
    return {side, rows_from_top(), owners_.covered};
  }

 private:
  std::size_t points_a_texel() const { return std::size_t{samples_} * samples_; }

  void paint_tile(std::uint32_t tile_x, std::uint32_t tile_y) {
    const std::uint32_t side = options_.texture_size;
    Asked asked;
    for (std::uint32_t y = tile_y * k_tile; y < std::min(side, (tile_y + 1) * k_tile); ++y) {
      for (std::uint32_t x = tile_x * k_tile; x < std::min(side, (tile_x + 1) * k_tile); ++x) {
        const std::uint32_t owner = owners_.at(x, y);
        if (owner == k_no_owner) continue;
        if (asked.points.size() + points_a_texel() > k_most_baked_points) paint(asked);
        asked.texels.push_back(std::size_t{y} * side + x);
        add_points(owner, x, y, asked);
      }
    }
    paint(asked);
  }

  void add_points(std::uint32_t owner, std::uint32_t x, std::uint32_t y, Asked& asked) const {
    const FlatTriangle& t = corners_[owner];
    for (std::uint32_t j = 0; j < samples_; ++j) {
      for (std::uint32_t i = 0; i < samples_; ++i) {
        const Flat p{x + (i + 0.5) / samples_, y + (j + 0.5) / samples_};
        const Corners inner = inner_shares(p, t);
        asked.points.push_back(blend(mesh_.positions, plane_shares(p, t).value_or(inner), owner));
        asked.normals.push_back(normal_at(inner, owner));
      }
    }
  }
  Vec3 blend(const std::vector<Vec3>& values, const Corners& shares, std::uint32_t triangle) const {
    const auto [a, b, c] = triangles_[triangle];
    return values[a] * shares[0] + values[b] * shares[1] + values[c] * shares[2];
  }

  /// The blend of the vertices' normals, if it is on the triangle's side; else the triangle's own.
  Vec3 normal_at(const Corners& shares, std::uint32_t triangle) const {
    const auto [a, b, c] = mesh_.triangles[triangle];
    const Vec3 p = mesh_.positions[a];
    const Vec3 flat = cross(mesh_.positions[b] - p, mesh_.positions[c] - p);
    const Vec3 smooth = blend(normals_, shares, triangle);
    const Vec3 chosen = dot(flat, smooth) > 0 ? smooth : flat;
    const double all = length(chosen);
    return all > 0 ? chosen * (1 / all) : Vec3{};
  }

  /// Asks for the colours, and leaves nothing to ask for.
  void paint(Asked& asked) {
    if (asked.points.empty()) return;
    std::vector<BakedColour> colours(asked.points.size());
    colours_at_(asked.points, asked.normals, colours);
    const std::size_t each = points_a_texel();
    for (std::size_t i = 0; i < asked.texels.size(); ++i) {
      Corners sum{};
      for (std::size_t k = i * each; k < (i + 1) * each; ++k) {
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(colours[k][c]);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        texels_[asked.texels[i]][c] = level(sum[c] / static_cast<double>(each));
      }
      is_set_[asked.texels[i]] = 1;
    }
    asked = {};
  }
  std::uint8_t level(double value) const {
    if (options_.level_of != nullptr) value = options_.level_of(value);
    if (!(value > 0)) return 0;
    return static_cast<std::uint8_t>(std::lround(std::min(value, 1.0) * 255));
  }

  std::vector<std::uint8_t> rows_from_top() const {
    const std::size_t side = options_.texture_size;
    std::vector<std::uint8_t> bytes(3 * texels_.size());
    for (std::size_t y = 0; y < side; ++y) {
      std::uint8_t* row = bytes.data() + 3 * side * (side - 1 - y);
      for (std::size_t x = 0; x < side; ++x) {
        std::copy_n(texels_[y * side + x].begin(), 3, row + 3 * x);
      }
    }
    return bytes;
  }

  const Mesh& mesh_;
  BakeOptions options_;
  const ColoursAt& colours_at_;
  std::uint32_t samples_;
  std::vector<FlatTriangle> corners_;  // in texels
  std::vector<Triangle> triangles_;    // counter-clockwise on the picture
  std::vector<Vec3> normals_;
  TexelOwners owners_;
  std::vector<Texel> texels_;
  std::vector<std::uint8_t> is_set_;
};

}  // namespace

BakedPicture bake(const Mesh& mesh, std::span<const std::array<std::array<float, 2>, 3>> uvs,
                  const BakeOptions& options, const ColoursAt& colours_at) {
  assert(uvs.size() == mesh.triangles.size());
  if (options.texture_size == 0) return {};
  return Baker(mesh, uvs, options, colours_at).run();
}

}  // namespace meshfarm
