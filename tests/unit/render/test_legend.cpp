// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include "render/legend.hpp"
#include "render/lettering.hpp"

using namespace meshfarm;

namespace {

Texels white(std::uint32_t width, std::uint32_t height) {
  Texels picture{.width = width, .height = height, .step = 3, .bytes = {}};
  picture.bytes.resize(std::size_t{3} * width * height, 255);
  return picture;
}

std::size_t inked(const Texels& picture) {
  return picture.bytes.size() -
         static_cast<std::size_t>(std::count(picture.bytes.begin(), picture.bytes.end(), 255));
}

}  // namespace

TEST_CASE("numbers of a scale are told in the digits that count") {
  CHECK(number_text(9000, 1000) == "9000");
  CHECK(number_text(0.5, 0.5) == "0.5");
  CHECK(number_text(-0.99134, 0.005) == "-0.991");
  CHECK(number_text(1e-17, 0.1) == "0.0");
  CHECK(number_text(2e9, 1e9) == "2e+09");
  CHECK(number_text(3e-7, 1e-7) == "3e-07");
  CHECK(number_text(0, 0) == "0");
  CHECK(number_text(0, 1e-6) == "0");
}

TEST_CASE(
    "all digits and letters look different, but for 0 and O, and letters beyond the sides are cut "
    "off") {
  const std::string all = "0123456789ABCDEFGHIJKLMNPQRSTUVWXYZ.,-+_/()%";
  std::vector<std::vector<std::uint8_t>> seen;
  for (const char letter : all) {
    CAPTURE(letter);
    Texels picture = white(24, 30);
    draw_text(picture, {4, 5, 18, {0, 0, 0}}, std::string(1, letter));
    CHECK(inked(picture) > 20);
    CHECK(std::find(seen.begin(), seen.end(), picture.bytes) == seen.end());
    seen.push_back(picture.bytes);
  }
  Texels picture = white(24, 30);
  draw_text(picture, {-30, -9, 18, {0, 0, 0}}, "beyond all sides of a picture");
  draw_text(picture, {500, 500, 18, {0, 0, 0}}, "beyond");
  CHECK(inked(picture) < picture.bytes.size());
}

TEST_CASE("a legend stays in its place, with the scale's colours at its ends") {
  Texels picture = white(400, 300);
  draw_legend(picture, "heat", {-3, 17.5}, {0, 0, 0});
  const std::uint32_t left = 400 - legend_width(300);
  CHECK(inked(picture) > 500);
  std::size_t outside = 0;
  for (std::uint32_t y = 0; y < 300; ++y) {
    for (std::uint32_t x = 0; x + 4 < left; ++x) outside += picture.at(x, y)[0] != 255;
  }
  CHECK(outside == 0);
  const auto colour_at = [&](std::uint32_t y) {
    const std::uint8_t* texel = picture.at(left + 2, y);
    return Srgb{texel[0], texel[1], texel[2]};
  };
  CHECK(colour_at(66 + 168 - 1)[0] < 60);  // dark below
  CHECK(colour_at(67)[0] > 200);           // light above
}
