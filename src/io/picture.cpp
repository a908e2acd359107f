// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "picture.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include <png.h>
#include <turbojpeg.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::string_view k_png_start("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view k_jpeg_start("\xff\xd8\xff", 3);

std::uint32_t big_endian(std::string_view bytes, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

[[noreturn]] void fail(const std::string& why) {
  throw DataError(why);
}

// signature, then chunks: length u32, type, data, sum u32; all big endian. The first is IHDR:
// width u32, height u32, depth u8, colour type u8, ...
constexpr std::size_t k_png_head_bytes = 26;

PictureHead read_png_head(std::string_view bytes) {
  if (bytes.size() < k_png_head_bytes || bytes.substr(12, 4) != "IHDR") {
    fail("a PNG without its header");
  }
  const char colour_type = bytes[25];
  return {.kind = PictureHead::Kind::png,
          .width = big_endian(bytes.substr(16), 4),
          .height = big_endian(bytes.substr(20), 4),
          .has_alpha = colour_type == PNG_COLOR_TYPE_GA || colour_type == PNG_COLOR_TYPE_RGBA};
}

bool is_frame(unsigned marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

// segments: 0xff, marker, length u16 with itself, data; of a frame: depth u8, height u16,
// width u16, components u8
PictureHead read_jpeg_head(std::string_view bytes) {
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (bytes[at] != '\xff') fail("a JPEG with a malformed header");
    const unsigned marker = big_endian(bytes.substr(at + 1), 1);
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    if (is_frame(marker)) {
      if (at + 10 > bytes.size()) break;
      const bool is_progressive = marker == 0xc2 || marker == 0xc6 || marker == 0xca;
      return {.kind = PictureHead::Kind::jpeg,
              .width = big_endian(bytes.substr(at + 7), 2),
              .height = big_endian(bytes.substr(at + 5), 2),
              .is_progressive = is_progressive};
    }
    if (marker == 0xd9 || marker == 0xda) break;
    at += 2 + std::size_t{big_endian(bytes.substr(at + 2), 2)};
  }
  fail("a JPEG without a frame");
}

/// Keeps only the chunks that define the texels. Without the others the levels are unchanged, and
/// less can be damaged.
void drop_other_chunks(std::string& png) {
  constexpr std::array<std::string_view, 4> k_kept{"IHDR", "PLTE", "IDAT", "IEND"};
  constexpr std::size_t k_frame_bytes = 12;
  std::size_t end = k_png_start.size();
  for (std::size_t at = end; at + k_frame_bytes <= png.size();) {
    const std::string_view chunk = std::string_view(png).substr(at);
    const std::size_t bytes =
        std::min<std::size_t>(chunk.size(), k_frame_bytes + std::size_t{big_endian(chunk, 4)});
    if (std::find(k_kept.begin(), k_kept.end(), chunk.substr(4, 4)) != k_kept.end()) {
      std::memmove(png.data() + end, png.data() + at, bytes);
      end += bytes;
    }
    at += bytes;
  }
  png.resize(end);
}

/// The maximum ratio of texels to their compressed size.
constexpr std::uint64_t k_most_deflated = 1040;

/// Refuses a truncated file before memory is allocated for its texels.
void check_has_texels(std::string_view png, const PictureHead& head) {
  const std::uint64_t bits = std::uint64_t{head.width} * static_cast<unsigned char>(png[24]);
  if (bits / 8 * head.height / k_most_deflated > png.size()) fail("a damaged PNG: truncated");
}

void decode_png(std::string bytes, const PictureHead& head, Picture& made) {
  drop_other_chunks(bytes);
  check_has_texels(bytes, head);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&image, png_image_free);
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
    fail(std::string("a damaged PNG: ") + image.message);
  }
  if (image.width != head.width || image.height != head.height) fail("a PNG with two headers");
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  // A format without alpha would blend the colours with a background.
  image.format = head.has_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  made.step = head.has_alpha ? 4 : 3;
  made.texels.resize(made.step * head.width * head.height);
  const auto row_bytes = static_cast<png_int_32>(made.step * head.width);
  if (png_image_finish_read(&image, nullptr, made.texels.data(), row_bytes, nullptr) == 0) {
    fail(std::string("a damaged PNG: ") + image.message);
  }
}

void decode_jpeg(const std::string& bytes, const PictureHead& head, Picture& made) {
  const std::unique_ptr<void, decltype(&tjDestroy)> decoder(tjInitDecompress(), tjDestroy);
  if (!decoder) fail("the JPEG decoder does not start");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0;
  int height = 0;
  int sampling = 0;
  int space = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &sampling, &space) !=
      0) {
    fail(std::string("a damaged JPEG: ") + tjGetErrorStr2(decoder.get()));
  }
  if (space == TJCS_CMYK || space == TJCS_YCCK) fail("a JPEG of four inks; save it as RGB");
  if (width != static_cast<int>(head.width) || height != static_cast<int>(head.height)) {
    fail("a JPEG with two headers");
  }
  made.texels.resize(made.step * head.width * head.height);
  if (tjDecompress2(decoder.get(), data, bytes.size(), made.texels.data(), width, 0, height,
                    TJPF_RGB, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) == 0) {
    return;
  }
  const std::string why = tjGetErrorStr2(decoder.get());
  // Other warnings are about bytes that many writers leave behind.
  const bool is_short = why.find("Premature end") != std::string::npos;
  if (is_short || tjGetErrorCode(decoder.get()) != TJERR_WARNING) fail("a damaged JPEG: " + why);
  made.oddity = why;
}

}  // namespace

std::uint64_t PictureHead::memory_bytes() const {
  const std::uint64_t texels = std::uint64_t{width} * height;
  // All coefficients of a progressive JPEG are held, 16 bits each.
  return texels * ((has_alpha ? 4 : 3) + (is_progressive ? 6 : 0));
}

PictureHead read_picture_head(std::string_view bytes) {
  PictureHead head;
  if (bytes.starts_with(k_png_start)) {
    head = read_png_head(bytes);
  } else if (bytes.starts_with(k_jpeg_start)) {
    head = read_jpeg_head(bytes);
  } else {
    fail("neither PNG nor JPEG");
  }
  const std::string size = std::to_string(head.width) + " x " + std::to_string(head.height);
  if (head.width == 0 || head.height == 0) fail("a picture of " + size + " texels");
  if (std::max(head.width, head.height) > k_most_picture_side ||
      std::uint64_t{head.width} * head.height > k_most_texels) {
    fail("a picture of " + size + " texels, more than is read: make it smaller");
  }
  return head;
}

Picture decode_picture(std::string bytes) {
  const PictureHead head = read_picture_head(bytes);
  Picture made{.width = head.width, .height = head.height, .texels = {}, .oddity = {}};
  head.kind == PictureHead::Kind::png ? decode_png(std::move(bytes), head, made)
                                      : decode_jpeg(bytes, head, made);
  return made;
}

}  // namespace meshfarm
