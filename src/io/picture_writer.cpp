// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "picture_writer.hpp"

#include <algorithm>
#include <memory>

#include <png.h>
#include <turbojpeg.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

void check_size(const Picture& picture) {
  const std::uint64_t texels = std::uint64_t{picture.width} * picture.height;
  if (texels == 0 || std::max(picture.width, picture.height) > k_most_picture_side ||
      texels > k_most_texels) {
    throw DataError("a picture of " + std::to_string(picture.width) + " x " +
                    std::to_string(picture.height) + " texels cannot be written");
  }
}

[[noreturn]] void fail_png(const png_image& image) {
  throw DataError(std::string("the PNG encoder fails: ") + image.message);
}

}  // namespace

std::string encode_png(const Picture& picture, PngSize size) {
  check_size(picture);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = picture.step == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  if (size == PngSize::soon) image.flags |= PNG_IMAGE_FLAG_FAST;
  const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&image, png_image_free);
  // Room for incompressible bytes, so that one compression is enough.
  png_alloc_size_t taken = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(taken, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &taken, 0, picture.texels.data(), 0,
                                nullptr) == 0) {
    fail_png(image);
  }
  bytes.resize(taken);
  bytes.shrink_to_fit();
  return bytes;
}

std::string encode_jpeg(const Picture& picture, const JpegOptions& options) {
  check_size(picture);
  const std::unique_ptr<void, decltype(&tjDestroy)> encoder(tjInitCompress(), tjDestroy);
  if (!encoder) throw DataError("the JPEG encoder does not start");
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(
      encoder.get(), picture.texels.data(), static_cast<int>(picture.width), 0,
      static_cast<int>(picture.height), picture.step == 4 ? TJPF_RGBX : TJPF_RGB, &bytes, &size,
      options.full_colour ? TJSAMP_444 : TJSAMP_420, options.quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(bytes, tjFree);
  if (failed != 0) {
    throw DataError(std::string("the JPEG encoder fails: ") + tjGetErrorStr2(encoder.get()));
  }
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace meshfarm
