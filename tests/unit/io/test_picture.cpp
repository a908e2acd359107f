// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>

#include <meshfarm/util/errors.hpp>

#include "picture_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

void check_gradient(const Picture& read, int tolerance) {
  const Picture made = gradient(64);
  REQUIRE(read.width == 64);
  REQUIRE(read.height == 64);
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int level = read.row(y)[x * read.step + i];
        CHECK(std::abs(level - int{made.row(y)[3 * x + i]}) <= tolerance);
      }
    }
  }
}

/// The message with which the picture is refused; empty if it is decoded.
std::string picture_refusal(const std::string& bytes) {
  try {
    decode_picture(bytes);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

/// A PNG whose first chunk claims this size.
std::string resized_png(std::uint32_t width, std::uint32_t height) {
  std::string bytes = png_of(gradient(64));
  for (int i = 0; i < 4; ++i) {
    bytes[16 + i] = static_cast<char>(width >> (24 - 8 * i));
    bytes[20 + i] = static_cast<char>(height >> (24 - 8 * i));
  }
  return bytes;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  const auto word = [](std::uint32_t value) {
    std::string made;
    for (int i = 24; i >= 0; i -= 8) made += static_cast<char>(value >> i);
    return made;
  };
  std::uint32_t sum = 0xffffffff;
  for (const char c : type + data) {
    sum ^= static_cast<unsigned char>(c);
    for (int i = 0; i < 8; ++i) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xedb88320U : 0U);
  }
  return word(static_cast<std::uint32_t>(data.size())) + type + data + word(~sum);
}

}  // namespace

TEST_CASE("a PNG is decoded to its levels, whatever it holds") {
  check_gradient(decode_picture(png_of(gradient(64))), 0);
  Picture alpha{.width = 64, .height = 64, .step = 4};
  const Picture plain = gradient(64);
  for (std::size_t i = 0; i < plain.texels.size(); i += 3) {
    alpha.texels.insert(alpha.texels.end(), {plain.texels[i], plain.texels[i + 1],
                                             plain.texels[i + 2], static_cast<std::uint8_t>(7)});
  }
  check_gradient(decode_picture(png_of(alpha)), 0);
}

TEST_CASE("a grey PNG is grey") {
  const std::array<std::uint8_t, 4> levels{0, 80, 160, 255};
  const Picture read = decode_picture(png_of(2, 2, levels.data(), PNG_FORMAT_GRAY));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint8_t* texel = read.row(static_cast<std::uint32_t>(i / 2)) + read.step * (i % 2);
    CHECK(texel[0] == levels[i]);
    CHECK(texel[1] == levels[i]);
    CHECK(texel[2] == levels[i]);
  }
}

TEST_CASE("a PNG's gamma is passed over") {
  std::string bytes = png_of(gradient(64));
  const std::size_t at = bytes.find("IDAT") - 4;
  bytes.insert(at, png_chunk("gAMA", std::string("\x00\x01\x86\xa0", 4)));  // linear
  check_gradient(decode_picture(bytes), 0);
}

TEST_CASE("a JPEG is decoded, at once and progressive") {
  const std::string plain = jpeg_of(gradient(64));
  check_gradient(decode_picture(plain), 4);
  CHECK_FALSE(read_picture_head(plain).is_progressive);
  const std::string progressive = jpeg_of(gradient(64), TJFLAG_PROGRESSIVE);
  check_gradient(decode_picture(progressive), 4);
  CHECK(read_picture_head(progressive).is_progressive);
  CHECK(read_picture_head(progressive).memory_bytes() == 64 * 64 * 9);
}

TEST_CASE("what is no picture, or damaged, is told in a line") {
  CHECK(picture_refusal("") == "neither PNG nor JPEG");
  CHECK(picture_refusal("GIF89a") == "neither PNG nor JPEG");
  CHECK(picture_refusal("\xff\xd8\xff").starts_with("a JPEG without"));
  const std::string png = png_of(gradient(64));
  const std::string jpeg = jpeg_of(gradient(64));
  for (std::size_t size = 8; size < png.size() - 12; size += 97) {  // the last chunk is empty
    CHECK(picture_refusal(png.substr(0, size)) != "");
  }
  for (std::size_t size = 3; size < jpeg.size() - 2; size += 97) {
    CHECK(picture_refusal(jpeg.substr(0, size)) != "");
  }
  std::string damaged = png;
  damaged[png.find("IDAT") + 20] ^= 0x55;
  CHECK(picture_refusal(damaged).starts_with("a damaged PNG: "));
}

TEST_CASE("bytes behind a JPEG's picture are let pass, and told") {
  std::string bytes = jpeg_of(gradient(64));
  bytes.insert(bytes.size() - 2, "left behind");
  const Picture read = decode_picture(bytes);
  check_gradient(read, 4);
  CHECK(read.oddity != "");
}

TEST_CASE("a picture that claims to be vast is refused before it takes memory") {
  CHECK(picture_refusal(resized_png(60'000, 60'000)).find("60000 x 60000") != std::string::npos);
  CHECK(picture_refusal(resized_png(1'000'000, 1)).find("make it smaller") != std::string::npos);
  CHECK(picture_refusal(resized_png(0, 5)) == "a picture of 0 x 5 texels");
  CHECK(read_picture_head(resized_png(32'768, 32'768)).memory_bytes() == std::uint64_t{3} << 30);
}
