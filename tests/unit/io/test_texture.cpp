// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "io/srgb.hpp"
#include "io/texture.hpp"
#include "picture_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr Texel k_texture_red{255, 0, 0};
constexpr Texel k_texture_green{0, 255, 0};

double level(float linear) {
  return 255 * srgb_of_linear(static_cast<double>(linear));
}

void check_all(const ThirdColours& thirds, const Texel& colour) {
  for (const LinearColour& corner : thirds.corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(level(corner[i]) == doctest::Approx(colour[i]).epsilon(1e-4));
    }
  }
}

ThirdColours thirds_of(const Texture& texture, const std::array<TexturePoint, 3>& corners) {
  const auto made = average_thirds(texture, corners);
  REQUIRE(made);
  return *made;
}

}  // namespace

TEST_CASE("a corner has the mean of its third, in light") {
  // Alternating white and black columns: half of the light, not half of the level.
  const Picture stripes = picture_of(64, 64, [](std::uint32_t x, std::uint32_t) {
    return x % 2 == 0 ? Texel{255, 255, 255} : Texel{0, 0, 0};
  });
  const ThirdColours made = thirds_of({stripes}, {{{0, 0}, {1, 0}, {0, 1}}});
  CHECK(made.texels == doctest::Approx(2048));
  for (const LinearColour& corner : made.corners) {
    CHECK(corner[0] == doctest::Approx(0.5).epsilon(0.02));
    CHECK(level(corner[1]) == doctest::Approx(188).epsilon(0.02));
  }
}

TEST_CASE("corners have the colours of their own thirds") {
  const Picture picture = gradient(256);
  const ThirdColours made = thirds_of({picture}, {{{0, 0}, {1, 0}, {0, 1}}});
  CHECK(level(made.corners[0][0]) < 80);
  CHECK(level(made.corners[1][0]) > 140);
  CHECK(level(made.corners[2][1]) > 140);
  CHECK(level(made.corners[2][0]) == doctest::Approx(level(made.corners[0][0])).epsilon(0.2));
}

TEST_CASE("nothing bleeds in from beside a chart") {
  // The chart is the triangle below the diagonal; everything outside it is green.
  const Picture atlas = picture_of(64, 64, [](std::uint32_t x, std::uint32_t y) {
    return x + y < 63 ? k_texture_red : k_texture_green;
  });
  const double side = 62.9 / 64;
  check_all(thirds_of({atlas}, {{{0, 0}, {side, 0}, {0, side}}}), k_texture_red);
}

TEST_CASE("of a triangle of many texels some are looked at, by a lattice") {
  const Picture atlas = picture_of(1024, 1024, [](std::uint32_t x, std::uint32_t y) {
    return x + y < 1023 ? k_texture_red : k_texture_green;
  });
  const double side = 1022.9 / 1024;
  check_all(thirds_of({atlas}, {{{0, 0}, {side, 0}, {0, side}}}), k_texture_red);
  // Any number of tiles takes bounded time.
  const ThirdColours tiled = thirds_of({atlas}, {{{0, 0}, {10'000, 0}, {0, 10'000}}});
  for (const LinearColour& corner : tiled.corners) {
    CHECK(corner[0] == doctest::Approx(0.5).epsilon(0.1));
    CHECK(corner[1] == doctest::Approx(0.5).epsilon(0.1));
  }
}

TEST_CASE("between texels the texture is interpolated") {
  const Picture picture = gradient(4);
  const double small = 1e-6;
  const double middle = 0.5;
  const ThirdColours made = thirds_of(
      {picture}, {{{middle, middle}, {middle + small, middle}, {middle, middle + small}}});
  const double light = (linear_of_srgb(85 / 255.0) + linear_of_srgb(170 / 255.0)) / 2;
  CHECK(made.corners[0][0] == doctest::Approx(light).epsilon(1e-3));
  // A point and a line have no area, but a colour.
  const ThirdColours point =
      thirds_of({picture}, {{{middle, middle}, {middle, middle}, {middle, middle}}});
  CHECK(point.texels == 0);
  CHECK(point.corners[2][1] == doctest::Approx(light).epsilon(1e-3));
}

TEST_CASE("a texture is wrapped as its sampler says") {
  const Picture halves = picture_of(
      8, 8, [](std::uint32_t x, std::uint32_t) { return x < 4 ? k_texture_red : k_texture_green; });
  const auto at = [&](TextureWrap wrap, double u) {
    return thirds_of({halves, wrap, wrap}, {{{u, 0.5}, {u, 0.5}, {u, 0.5}}});
  };
  check_all(at(TextureWrap::repeat, 1.25), k_texture_red);
  check_all(at(TextureWrap::repeat, -0.25), k_texture_green);
  check_all(at(TextureWrap::mirror, 1.25), k_texture_green);
  check_all(at(TextureWrap::mirror, -0.25), k_texture_red);
  check_all(at(TextureWrap::mirror, 2.25), k_texture_red);
  check_all(at(TextureWrap::clamp, 1.25), k_texture_green);
  check_all(at(TextureWrap::clamp, -7), k_texture_red);
}

TEST_CASE("places that are no numbers, or beyond all pictures, have no colour") {
  const Picture picture = gradient(4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(average_thirds({picture}, {{{nan, 0}, {1, 0}, {0, 1}}}));
  CHECK_FALSE(average_thirds({picture}, {{{0, 0}, {1e30, 0}, {0, 1}}}));
}
