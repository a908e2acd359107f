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
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/texture/bake_fill.hpp"
#include "geometry/texture/bake_owners.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_tile = 64;  // texels per side that are painted together
/// Outside a triangle lower than this, in texels, its plane does not represent the surface.
constexpr double k_least_height = 0.25;

using TexelCorners = std::array<double, 3>;

/// The corners' shares at a point, which may lie outside.
std::optional<TexelCorners> plane_shares(Flat p, const FlatTriangle& t) {
  const double all = doubled_area(t);
  const double longest = std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
  if (!(all > longest * k_least_height)) return {};
  const double of_b = cross(p - t[0], t[2] - t[0]) / all;
  const double of_c = cross(t[1] - t[0], p - t[0]) / all;
  return TexelCorners{1 - of_b - of_c, of_b, of_c};
}

/// The corners' shares at the triangle's nearest point.
TexelCorners inner_shares(Flat p, const FlatTriangle& t) {
  return nearest_shares({p.x, p.y, 0}, {t[0].x, t[0].y, 0}, {t[1].x, t[1].y, 0},
                        {t[2].x, t[2].y, 0});
}

/// Points of one tile that wait for their colours, `samples * samples` per texel.
struct Asked {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;
};

/// Paints the picture tile by tile.
class Baker {
 public:
  Baker(const BakeSurface& surface, const BakeOptions& options, const ColoursAt& colours_at)
      : surface_(surface),
        options_(options),
        colours_at_(colours_at),
        samples_(std::clamp(options.samples, 1U, 16U)),
        tiles_a_side_((options.texture_size + k_tile - 1) / k_tile),
        corners_(surface.uvs.size()),
        triangles_(surface.triangles) {
    const double side = options.texture_size;
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners_[t][k] = {static_cast<double>(surface.uvs[t][k][0]) * side,
                          static_cast<double>(surface.uvs[t][k][1]) * side};
      }
      if (doubled_area(corners_[t]) >= 0) continue;
      std::swap(corners_[t][1], corners_[t][2]);
      std::swap(triangles_[t][1], triangles_[t][2]);
    }
  }

  BakedTexels run() {
    sort_into_tiles();
    std::vector<BakedTexels> tiles(tiles_.size());
    parallel_for(tiles.size(), options_.threads,
                 [&](std::uint64_t tile) { tiles[tile] = paint_tile(tiles_[tile]); });
    BakedTexels all;
    for (BakedTexels& tile : tiles) {
      all.runs.insert(all.runs.end(), tile.runs.begin(), tile.runs.end());
      all.levels.insert(all.levels.end(), tile.levels.begin(), tile.levels.end());
      tile = {};
    }
    return all;
  }

 private:
  struct Tile {
    TexelWindow window;
    std::vector<std::uint32_t> triangles;  // that are near it
    bool has_own = false;
  };

  std::size_t points_a_texel() const { return std::size_t{samples_} * samples_; }

  void sort_into_tiles() {
    const std::uint32_t side = options_.texture_size;
    const double margin = 2.0 * options_.margin_texels + 1;
    std::vector<Tile> all(std::size_t{tiles_a_side_} * tiles_a_side_);
    const auto tile = [&](double x) {
      return static_cast<std::uint32_t>(std::clamp(x / k_tile, 0.0, tiles_a_side_ - 1.0));
    };
    for (std::uint32_t t = 0; t < corners_.size(); ++t) {
      FlatBox box;
      box.add(corners_[t]);
      for (std::uint32_t y = tile(box.lo.y - margin); y <= tile(box.hi.y + margin); ++y) {
        for (std::uint32_t x = tile(box.lo.x - margin); x <= tile(box.hi.x + margin); ++x) {
          Tile& near = all[std::size_t{y} * tiles_a_side_ + x];
          near.triangles.push_back(t);
          near.has_own = near.has_own || surface_.is_own[t] != 0;
          near.window = {x * k_tile, y * k_tile, std::min(side, (x + 1) * k_tile),
                         std::min(side, (y + 1) * k_tile)};
        }
      }
    }
    for (Tile& each : all) {
      if (each.has_own) tiles_.push_back(std::move(each));
    }
  }

  BakedTexels paint_tile(const Tile& tile) {
    const std::uint32_t margin = options_.margin_texels;
    const TexelOwners owners(corners_, tile.triangles,
                             tile.window.grown(margin, options_.texture_size), margin);
    BakedTexels made;
    Asked asked;
    for (std::uint32_t y = tile.window.y0; y < tile.window.y1; ++y) {
      for (std::uint32_t x = tile.window.x0; x < tile.window.x1; ++x) {
        const std::uint32_t owner = owners.at(x, y);
        if (owner == k_no_owner || surface_.is_own[owner] == 0) continue;
        if (asked.points.size() + points_a_texel() > k_most_baked_points) paint(asked, made);
        add_to_runs(x, y, made.runs);
        add_points(owner, x, y, asked);
      }
    }
    paint(asked, made);
    return made;
  }

  static void add_to_runs(std::uint32_t x, std::uint32_t y, std::vector<TexelRun>& runs) {
    const bool goes_on =
        !runs.empty() && runs.back().y == y && runs.back().x + runs.back().count == x;
    if (!goes_on) runs.push_back({x, y, 0});
    ++runs.back().count;
  }

  void add_points(std::uint32_t owner, std::uint32_t x, std::uint32_t y, Asked& asked) const {
    const FlatTriangle& t = corners_[owner];
    for (std::uint32_t j = 0; j < samples_; ++j) {
      for (std::uint32_t i = 0; i < samples_; ++i) {
        const Flat p{x + (i + 0.5) / samples_, y + (j + 0.5) / samples_};
        const TexelCorners inner = inner_shares(p, t);
        asked.points.push_back(
            blend(surface_.positions, plane_shares(p, t).value_or(inner), owner));
        asked.normals.push_back(normal_at(inner, owner));
      }
    }
  }
  Vec3 blend(const std::vector<Vec3>& values, const TexelCorners& shares,
             std::uint32_t triangle) const {
    const auto [a, b, c] = triangles_[triangle];
    return values[a] * shares[0] + values[b] * shares[1] + values[c] * shares[2];
  }

  /// The interpolated vertex normal, if it is on the triangle's side; otherwise the triangle's own.
  Vec3 normal_at(const TexelCorners& shares, std::uint32_t triangle) const {
    const auto [a, b, c] = surface_.triangles[triangle];
    const Vec3 p = surface_.positions[a];
    const Vec3 flat = cross(surface_.positions[b] - p, surface_.positions[c] - p);
    const Vec3 smooth = blend(surface_.normals, shares, triangle);
    const Vec3 chosen = dot(flat, smooth) > 0 ? smooth : flat;
    const double all = length(chosen);
    return all > 0 ? chosen * (1 / all) : Vec3{};
  }

  /// Asks for the colours of all waiting points, and clears `asked`.
  void paint(Asked& asked, BakedTexels& made) const {
    if (asked.points.empty()) return;
    std::vector<BakedColour> colours(asked.points.size());
    colours_at_(asked.points, asked.normals, colours);
    const std::size_t each = points_a_texel();
    for (std::size_t first = 0; first < colours.size(); first += each) {
      TexelCorners sum{};
      for (std::size_t k = first; k < first + each; ++k) {
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(colours[k][c]);
      }
      TexelLevels& levels = made.levels.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) levels[c] = level(sum[c] / static_cast<double>(each));
    }
    asked = {};
  }
  std::uint8_t level(double value) const {
    if (options_.level_of != nullptr) value = options_.level_of(value);
    if (!(value > 0)) return 0;
    return static_cast<std::uint8_t>(std::lround(std::min(value, 1.0) * 255));
  }

  const BakeSurface& surface_;
  BakeOptions options_;
  const ColoursAt& colours_at_;
  std::uint32_t samples_;
  std::uint32_t tiles_a_side_;
  std::vector<FlatTriangle> corners_;  // in texels
  std::vector<Triangle> triangles_;    // counter-clockwise on the picture
  std::vector<Tile> tiles_;            // where own triangles are
};

}  // namespace

BakeSurface surface_to_bake(const Mesh& mesh, std::span<const CornerUvs> uvs) {
  assert(uvs.size() == mesh.triangles.size());
  BakeSurface surface{mesh.positions, vertex_normals(mesh), mesh.triangles, {}, {}};
  surface.uvs.assign(uvs.begin(), uvs.end());
  surface.is_own.assign(uvs.size(), 1);
  return surface;
}

BakedTexels bake_texels(const BakeSurface& surface, const BakeOptions& options,
                        const ColoursAt& colours_at) {
  if (options.texture_size == 0) return {};
  return Baker(surface, options, colours_at).run();
}

BakedCanvas::BakedCanvas(std::uint32_t side)
    : side_(side), texels_(std::size_t{side} * side), is_set_(texels_.size(), 0) {}

void BakedCanvas::add(const BakedTexels& texels) {
  std::size_t next = 0;
  for (const TexelRun& run : texels.runs) {
    const bool fits = run.y < side_ && run.x < side_ && run.count <= side_ - run.x &&
                      run.count <= texels.levels.size() - next;
    if (!fits) throw DataError("texels that are not of this picture");
    const std::size_t at = std::size_t{run.y} * side_ + run.x;
    std::copy_n(texels.levels.begin() + static_cast<std::ptrdiff_t>(next), run.count,
                texels_.begin() + static_cast<std::ptrdiff_t>(at));
    std::fill_n(is_set_.begin() + static_cast<std::ptrdiff_t>(at), run.count, 1);
    next += run.count;
  }
}

BakedPicture BakedCanvas::finish(unsigned threads) {
  if (side_ == 0) return {};
  fill_texels(texels_, is_set_, side_, threads);
  BakedPicture picture{side_, std::vector<std::uint8_t>(3 * texels_.size())};
  const std::size_t side = side_;
  for (std::size_t y = 0; y < side; ++y) {
    std::uint8_t* row = picture.texels.data() + 3 * side * (side - 1 - y);
    for (std::size_t x = 0; x < side; ++x) {
      std::copy_n(texels_[y * side + x].begin(), 3, row + 3 * x);
    }
  }
  texels_ = {};
  is_set_ = {};
  return picture;
}

}  // namespace meshfarm
