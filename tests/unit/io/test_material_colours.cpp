// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

namespace {

/// Four by four grey levels: 16 times the texel's index (0 to 15), row by row from the top.
std::string grey_steps() {
  std::vector<std::uint8_t> texels;
  for (int i = 0; i < 16; ++i) texels.insert(texels.end(), 3, static_cast<std::uint8_t>(16 * i));
  return encoded_picture(4, std::move(texels), PictureCoding::png);
}

LabelMeaning one_material(TextureWrap wrap) {
  Material material{.name = "m"};
  material.maps = {{MapUse::normal, 1}, {MapUse::colour, 0}};
  material.wrap_u = material.wrap_v = wrap;
  return {"material", {material, {.name = "plain", .colour = {0.5F, 0.25F, 1, 1}}}};
}

PictureFiles files() {
  return {{"a.png", "n.png"}, [](std::size_t i) { return i == 0 ? grey_steps() : "none"; }};
}

/// The centre of a texel, x from the left and y from the top.
Uv centre(int x, int y) {
  return {(static_cast<float>(x) + 0.5F) / 4, 1 - (static_cast<float>(y) + 0.5F) / 4};
}

double level_at(const MaterialColours& colours, Uv uv, double texels = 1) {
  return 255 * srgb_level(static_cast<double>(colours.at(0, uv, texels)[0]));
}

}  // namespace

TEST_CASE("a material shows its picture, the first row at the top") {
  const MaterialColours colours(one_material(TextureWrap::repeat), files(), {.name = "mesh"});
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      CHECK(level_at(colours, centre(x, y)) == doctest::Approx(16 * (4 * y + x)).epsilon(1e-4));
    }
  }
  CHECK(colours.texels_of(0, {{{0, 0}, {1, 0}, {0, 0.5F}}}) == doctest::Approx(4));
  CHECK(colours.texels_of(1, {{{0, 0}, {1, 0}, {0, 0.5F}}}) == 0);
}

TEST_CASE("a material without a picture has its colour") {
  const MaterialColours colours(one_material(TextureWrap::repeat), files(), {.name = "mesh"});
  CHECK(colours.at(1, {0.3F, 0.7F}, 1) == std::array<float, 3>{0.5F, 0.25F, 1});
}

TEST_CASE("beyond the sides a picture comes again, mirrored or not, or goes on") {
  const Uv inside = centre(1, 2);
  const Uv right = {inside[0] + 1, inside[1]};
  const Uv mirror = {2 - inside[0], inside[1]};
  const MaterialColours repeated(one_material(TextureWrap::repeat), files(), {.name = "mesh"});
  CHECK(level_at(repeated, right) == doctest::Approx(16 * 9).epsilon(1e-4));
  const MaterialColours mirrored(one_material(TextureWrap::mirror), files(), {.name = "mesh"});
  CHECK(level_at(mirrored, mirror) == doctest::Approx(16 * 9).epsilon(1e-4));
  const MaterialColours clamped(one_material(TextureWrap::clamp), files(), {.name = "mesh"});
  CHECK(level_at(clamped, right) == doctest::Approx(16 * 11).epsilon(1e-4));
  CHECK(level_at(clamped, {NAN, inside[1]}) == doctest::Approx(16 * 8).epsilon(1e-4));
}

TEST_CASE("from afar a picture shows the mean of its texels") {
  const MaterialColours colours(one_material(TextureWrap::clamp), files(), {.name = "mesh"});
  const double whole = level_at(colours, {0.5F, 0.5F}, 4);
  CHECK(whole > 120);  // the mean of the light is above the mean of the levels
  CHECK(whole < 150);
  CHECK(level_at(colours, {0.1F, 0.9F}, 4) == doctest::Approx(whole));
  CHECK(level_at(colours, {0.25F, 0.75F}, 2) < 64);
}

TEST_CASE("a damaged picture leaves the material's colour, and too large ones are refused") {
  const PictureFiles damaged{{"a.png", "n.png"}, [](std::size_t) { return std::string("none"); }};
  const MaterialColours colours(one_material(TextureWrap::clamp), damaged, {.name = "mesh"});
  CHECK(colours.at(0, {0.5F, 0.5F}, 1) == std::array<float, 3>{1, 1, 1});
  CHECK_THROWS_AS(MaterialColours(one_material(TextureWrap::clamp), files(),
                                  {.name = "mesh", .memory_bytes = 50}),
                  DataError);
}
