// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <cmath>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/bake_chunks.hpp>
#include <meshfarm/geometry/surface_places.hpp>
#include <meshfarm/util/errors.hpp>

#include "atlas_checks.hpp"
#include "geometry/random_unit.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// A smooth field of colours.
BakedColour field(Vec3 p) {
  const auto wave = [](double x) { return static_cast<float>(0.5 + 0.4 * std::sin(x)); };
  return {wave(4 * p.x + p.y), wave(5 * p.y - 2 * p.z), wave(3 * p.z + 3 * p.x)};
}

void ask_field(std::span<const Vec3> points, std::span<const Vec3>, std::span<BakedColour> to) {
  std::transform(points.begin(), points.end(), to.begin(), field);
}

BakedPicture bake(const Mesh& mesh, std::span<const CornerUvs> uvs, const BakeOptions& options,
                  const ColoursAt& colours_at) {
  BakedCanvas canvas(options.texture_size);
  canvas.add(bake_texels(surface_to_bake(mesh, uvs), options, colours_at));
  return canvas.finish(options.threads);
}

/// A picture of some mip level, row by row from the top.
struct Mip {
  std::uint32_t side;
  std::vector<std::array<double, 3>> texels;

  std::array<double, 3> at(long x, long y) const {
    const long last = static_cast<long>(side) - 1;
    return texels[static_cast<std::size_t>(std::clamp(y, 0L, last) * (last + 1) +
                                           std::clamp(x, 0L, last))];
  }
  /// Filtered as graphics cards do it.
  std::array<double, 3> bilinear(double u, double v) const {
    const double x = u * side - 0.5, y = (1 - v) * side - 0.5;
    const long i = static_cast<long>(std::floor(x)), j = static_cast<long>(std::floor(y));
    const double s = x - static_cast<double>(i), t = y - static_cast<double>(j);
    std::array<double, 3> made{};
    for (std::size_t c = 0; c < 3; ++c) {
      made[c] = (1 - t) * ((1 - s) * at(i, j)[c] + s * at(i + 1, j)[c]) +
                t * ((1 - s) * at(i, j + 1)[c] + s * at(i + 1, j + 1)[c]);
    }
    return made;
  }
};

Mip mip_of(const BakedPicture& picture, std::uint32_t box) {
  Mip made{picture.side / box, {}};
  made.texels.resize(std::size_t{made.side} * made.side);
  for (std::size_t y = 0; y < picture.side; ++y) {
    for (std::size_t x = 0; x < picture.side; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        made.texels[y / box * made.side + x / box][c] +=
            picture.texels[3 * (y * picture.side + x) + c] / (255.0 * box * box);
      }
    }
  }
  return made;
}

/// How close the picture on the mesh comes to the field, in decibels: measured all over each
/// triangle, sides and corners included.
double decibels(const Mesh& mesh, const Atlas& atlas, const Mip& picture) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; i + j <= 6; ++j) {
        const double r = i / 6.0, s = j / 6.0, q = 1 - r - s;
        const Vec3 p = mesh.positions[a] * q + mesh.positions[b] * r + mesh.positions[c] * s;
        const auto uv = [&](std::size_t k) {
          const auto& corners = atlas.uvs[t];
          return q * static_cast<double>(corners[0][k]) + r * static_cast<double>(corners[1][k]) +
                 s * static_cast<double>(corners[2][k]);
        };
        const auto seen = picture.bilinear(uv(0), uv(1));
        for (std::size_t k = 0; k < 3; ++k) {
          const double apart = seen[k] - static_cast<double>(field(p)[k]);
          squares += apart * apart;
          ++count;
        }
      }
    }
  }
  return -10 * std::log10(squares / static_cast<double>(count));
}

}  // namespace

TEST_CASE("a field of colours is seen again, from near and from afar") {
  for (const Mesh& mesh : {icosphere(3), torus(48, 24)}) {
    const Atlas atlas = make_atlas(mesh, {.texture_size = 512});
    const BakedPicture picture = bake(mesh, atlas.uvs, {.texture_size = 512}, ask_field);
    CHECK(picture.side == 512);
    const double near = decibels(mesh, atlas, mip_of(picture, 1));
    const double afar = decibels(mesh, atlas, mip_of(picture, 4));
    MESSAGE(near, " dB, at mip level 2 ", afar);
    CHECK(near > 45);
    CHECK(afar > 35);
  }
}

TEST_CASE("what bilinear filtering touches is of the surface, nothing of the picture is black") {
  const Mesh mesh = torus(30, 15);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 256});
  const auto white = [](std::span<const Vec3>, std::span<const Vec3>, std::span<BakedColour> to) {
    std::fill(to.begin(), to.end(), BakedColour{1, 1, 1});
  };
  const BakedPicture picture = bake(mesh, atlas.uvs, {.texture_size = 256}, white);
  CHECK(picture.texels.size() == 3 * 256 * 256);
  CHECK(std::all_of(picture.texels.begin(), picture.texels.end(),
                    [](std::uint8_t level) { return level == 255; }));
}

TEST_CASE("round each chart the surface goes on for the margin") {
  // The colours are x and y in the sheet's plane, so they tell where a texel is; z is left out.
  const Mesh mesh = grid(4, 4);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 128, .margin_texels = 6});
  std::atomic<std::size_t> asked = 0;
  const auto place = [&](std::span<const Vec3> points, std::span<const Vec3> normals,
                         std::span<BakedColour> to) {
    REQUIRE(points.size() <= k_most_baked_points);
    asked += points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      REQUIRE(length(normals[i] - Vec3{0, 0, 1}) < 1e-9);
      to[i] = {static_cast<float>((points[i].x + 1) / 6), static_cast<float>((points[i].y + 1) / 6),
               0};
    }
  };
  const BakedPicture picture =
      bake(mesh, atlas.uvs, {.texture_size = 128, .margin_texels = 6}, place);
  CHECK(asked == 128 * 128);
  // Levels rise evenly from one side of the picture to the other, also outside the sheet.
  const auto level = [&](std::size_t x, std::size_t y, std::size_t c) {
    return int{picture.texels[3 * (y * 128 + x) + c]};
  };
  const std::size_t along = std::abs(level(127, 64, 0) - level(0, 64, 0)) > 20 ? 0 : 1;
  const int step = level(80, 64, along) - level(48, 64, along);
  CHECK(std::abs((level(127, 64, along) - level(95, 64, along)) - step) <= 2);
  CHECK(std::abs((level(32, 64, along) - level(0, 64, along)) - step) <= 2);
}

TEST_CASE("threads change nothing of a baked picture") {
  const Mesh mesh = torus(40, 20);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 300});
  const BakedPicture one =
      bake(mesh, atlas.uvs, {.texture_size = 300, .samples = 2, .threads = 1}, ask_field);
  const BakedPicture four =
      bake(mesh, atlas.uvs, {.texture_size = 300, .samples = 2, .threads = 4}, ask_field);
  CHECK(one.texels == four.texels);
}

TEST_CASE("more samples a texel smooth what is finer than texels") {
  const Mesh mesh = grid(4, 4);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 64});
  const auto stripes = [](std::span<const Vec3> points, std::span<const Vec3>,
                          std::span<BakedColour> to) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_light = std::fmod(std::floor((points[i].x + 9) * 41), 2) == 0;
      to[i] = is_light ? BakedColour{1, 1, 1} : BakedColour{0, 0, 0};
    }
  };
  const auto grey = [&](std::uint32_t samples) {
    const BakedPicture picture =
        bake(mesh, atlas.uvs, {.texture_size = 64, .samples = samples}, stripes);
    return std::count_if(picture.texels.begin(), picture.texels.end(),
                         [](std::uint8_t level) { return level > 50 && level < 205; });
  };
  CHECK(grey(1) == 0);
  CHECK(grey(4) > 3 * 64 * 64 * 9 / 10);
}

TEST_CASE("a curve makes levels of the means") {
  const Mesh mesh = grid(1, 1);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 32});
  const auto half = [](std::span<const Vec3>, std::span<const Vec3>, std::span<BakedColour> to) {
    std::fill(to.begin(), to.end(), BakedColour{0.25F, 2, -1});
  };
  const BakedPicture picture =
      bake(mesh, atlas.uvs, {.texture_size = 32, .level_of = [](double x) { return std::sqrt(x); }},
           half);
  CHECK(int{picture.texels[0]} == 128);
  CHECK(int{picture.texels[1]} == 255);
  CHECK(int{picture.texels[2]} == 0);
}

TEST_CASE("colours come from the finer surface that a mesh stands for") {
  const Mesh fine = icosphere(5), coarse = icosphere(2);
  const Atlas atlas = make_atlas(coarse, {.texture_size = 256});
  const SurfacePlaces places(fine, {});
  const auto nearest = [&](std::span<const Vec3> points, std::span<const Vec3> normals,
                           std::span<BakedColour> to) {
    std::vector<SurfacePlace> found(points.size());
    places.find(points, normals, found);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [a, b, c] = fine.triangles[found[i].triangle];
      to[i] = blended(found[i], field(fine.positions[a]), field(fine.positions[b]),
                      field(fine.positions[c]));
    }
  };
  const BakedPicture picture = bake(coarse, atlas.uvs, {.texture_size = 256}, nearest);
  // The coarse mesh is up to 0.03 inside of the sphere.
  CHECK(decibels(coarse, atlas, mip_of(picture, 1)) > 28);
  const Mip mip = mip_of(picture, 1);
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [u, v] = atlas.uvs[t][k];
      const auto seen = mip.bilinear(static_cast<double>(u), static_cast<double>(v));
      const BakedColour told = field(coarse.positions[coarse.triangles[t][k]]);
      for (std::size_t c = 0; c < 3; ++c) {
        CHECK(std::abs(seen[c] - static_cast<double>(told[c])) < 0.05);
      }
    }
  }
}

TEST_CASE("triangles that are turned over or of no area on the picture are painted") {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}}};
  const std::vector<std::array<std::array<float, 2>, 3>> uvs = {
      {{{0.9F, 0.1F}, {0.1F, 0.1F}, {0.1F, 0.9F}}},
      {{{0.9F, 0.1F}, {0.1F, 0.9F}, {0.9F, 0.9F}}},
      {{{0.5F, 0.5F}, {0.5F, 0.5F}, {0.5F, 0.5F}}}};
  const BakedPicture picture = bake(mesh, uvs, {.texture_size = 20}, ask_field);
  const BakedColour told = field({0.5, 0.5, 0});  // v = 1/2, u = 1/2
  const Mip mip = mip_of(picture, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(mip.bilinear(0.5, 0.5)[c] == doctest::Approx(static_cast<double>(told[c])).epsilon(0.02));
  }
  const BakedColour left = field({0.75, 0.25, 0});
  CHECK(mip.bilinear(0.3, 0.3)[0] == doctest::Approx(static_cast<double>(left[0])).epsilon(0.02));
}

TEST_CASE("a picture of nothing is grey") {
  const BakedPicture picture = bake({}, {}, {.texture_size = 7}, ask_field);
  CHECK(picture.texels == std::vector<std::uint8_t>(3 * 7 * 7, 128));
}

TEST_CASE("chunks make the picture that the whole makes") {
  for (const Mesh& mesh : {torus(40, 20), icosphere(3)}) {
    const Atlas atlas = make_atlas(mesh, {.texture_size = 300});
    const BakeOptions options{.texture_size = 300};
    const BakedPicture whole = bake(mesh, atlas.uvs, options, ask_field);
    for (const std::uint64_t triangles : {1000U, 150U, 7U}) {
      const BakeChunks chunks(mesh, atlas.uvs, {.texture_size = 300, .triangles = triangles});
      CHECK(chunks.size() >= mesh.triangles.size() / triangles);
      BakedCanvas canvas(300);
      std::size_t own = 0;
      for (std::size_t i = chunks.size(); i-- > 0;) {
        const BakeSurface surface = chunks.surface(i);
        own += static_cast<std::size_t>(
            std::count(surface.is_own.begin(), surface.is_own.end(), std::uint8_t{1}));
        canvas.add(bake_texels(surface, options, ask_field));
      }
      CHECK(own == mesh.triangles.size());
      CHECK(canvas.finish().texels == whole.texels);
    }
  }
}

TEST_CASE("chunks are no more than asked for, and hold about as much each") {
  const Mesh mesh = torus(80, 40);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 512});
  const BakeChunks chunks(mesh, atlas.uvs,
                          {.texture_size = 512, .texels = 1000, .most_chunks = 10});
  REQUIRE(chunks.size() == 10);
  std::uint64_t all = 0, most = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    all += chunks.texels(i);
    most = std::max(most, chunks.texels(i));
  }
  CHECK(static_cast<double>(all) == doctest::Approx(atlas.coverage * 512 * 512).epsilon(0.01));
  CHECK(static_cast<double>(most) < 1.3 * static_cast<double>(all) / 10);
  CHECK(BakeChunks({}, {}, {}).size() == 0);
}

TEST_CASE("texels that are not of the picture are refused") {
  const std::vector<TexelLevels> two(2);
  for (const TexelRun run : {TexelRun{7, 0, 2}, TexelRun{0, 8, 1}, TexelRun{0, 0, 3},
                             TexelRun{8, 0, 0}, TexelRun{1, 1, 0xffffffff}}) {
    BakedCanvas canvas(8);
    CHECK_THROWS_AS(canvas.add({{run}, two}), DataError);
  }
  BakedCanvas canvas(8);
  canvas.add({{{6, 7, 2}}, two});
  CHECK(canvas.finish().texels[0] == 0);
}
