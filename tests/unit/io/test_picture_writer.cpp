// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>

#include <meshfarm/util/errors.hpp>

#include "io/picture_writer.hpp"
#include "picture_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// The largest difference between levels.
int difference(const Picture& a, const Picture& b) {
  REQUIRE(a.width == b.width);
  REQUIRE(a.height == b.height);
  int most = 0;
  for (std::uint32_t y = 0; y < a.height; ++y) {
    for (std::uint32_t x = 0; x < a.width; ++x) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int of_a = a.row(y)[x * a.step + i], of_b = b.row(y)[x * b.step + i];
        most = std::max(most, std::abs(of_a - of_b));
      }
    }
  }
  return most;
}

/// Noise, which does not compress.
Picture noise(std::uint32_t width, std::uint32_t height) {
  std::uint32_t state = 1;
  return picture_of(width, height, [&state](std::uint32_t, std::uint32_t) {
    state = state * 1664525 + 1013904223;
    return Texel{static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                 static_cast<std::uint8_t>(state >> 8)};
  });
}

}  // namespace

TEST_CASE("a PNG that is written holds all levels") {
  for (const Picture& picture : {gradient(64), noise(37, 11), noise(1, 1)}) {
    const std::string bytes = encode_png(picture);
    CHECK(difference(decode_picture(bytes), picture) == 0);
    CHECK(encode_png(picture) == bytes);
  }
}

TEST_CASE("a picture with alpha is written, too") {
  Picture alpha{.width = 8, .height = 4, .step = 4};
  for (std::uint32_t i = 0; i < 8 * 4; ++i) {
    for (const std::uint32_t level : {7 * i, 100 + i, 255 - i, i}) {
      alpha.texels.push_back(static_cast<std::uint8_t>(level));
    }
  }
  const Picture read = decode_picture(encode_png(alpha));
  CHECK(read.texels == alpha.texels);
  CHECK(difference(decode_picture(encode_jpeg(alpha, {.quality = 100})), alpha) < 30);
}

TEST_CASE("a JPEG that is written is near, and the nearer the better its quality") {
  const Picture picture = gradient(64);
  const std::string good = encode_jpeg(picture, {.quality = 98});
  CHECK(difference(decode_picture(good), picture) <= 4);
  CHECK(encode_jpeg(picture, {.quality = 98}) == good);
  const Picture rough = noise(64, 64);
  const std::string small = encode_jpeg(rough, {.quality = 30, .full_colour = false});
  CHECK(small.size() < encode_jpeg(rough).size() / 2);
  CHECK(decode_picture(small).width == 64);
}

TEST_CASE("a picture that no file can hold is refused") {
  Picture wide{.width = k_most_picture_side + 1, .height = 1};
  wide.texels.resize(std::size_t{3} * wide.width);
  CHECK_THROWS_AS(encode_png(wide), DataError);
  CHECK_THROWS_AS(encode_jpeg(wide), DataError);
  CHECK_THROWS_AS(encode_png(Picture{}), DataError);
}
