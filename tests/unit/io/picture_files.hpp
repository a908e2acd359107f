// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <png.h>
#include <turbojpeg.h>

#include <meshfarm/io/mesh_source.hpp>

#include "io/picture.hpp"

namespace meshfarm::test {

using Texel = std::array<std::uint8_t, 3>;

inline Picture picture_of(std::uint32_t width, std::uint32_t height,
                          const std::function<Texel(std::uint32_t x, std::uint32_t y)>& texel) {
  Picture made{.width = width, .height = height};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      for (const std::uint8_t level : texel(x, y)) made.texels.push_back(level);
    }
  }
  return made;
}

/// Red increases to the right, green downwards.
inline Picture gradient(std::uint32_t size) {
  return picture_of(size, size, [size](std::uint32_t x, std::uint32_t y) {
    return Texel{static_cast<std::uint8_t>(255 * x / (size - 1)),
                 static_cast<std::uint8_t>(255 * y / (size - 1)), 100};
  });
}

/// `format` describes the texels, for example PNG_FORMAT_RGB.
inline std::string png_of(std::uint32_t width, std::uint32_t height, const void* texels,
                          png_uint_32 format) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = format;
  png_alloc_size_t size = 0;
  REQUIRE(png_image_write_to_memory(&image, nullptr, &size, 0, texels, 0, nullptr) != 0);
  std::string bytes(size, '\0');
  REQUIRE(png_image_write_to_memory(&image, bytes.data(), &size, 0, texels, 0, nullptr) != 0);
  bytes.resize(size);
  return bytes;
}

inline std::string png_of(const Picture& picture) {
  return png_of(picture.width, picture.height, picture.texels.data(),
                picture.step == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB);
}

inline std::string jpeg_of(const Picture& picture, int flags = 0, int sampling = TJSAMP_444) {
  const tjhandle encoder = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  REQUIRE(tjCompress2(encoder, picture.texels.data(), static_cast<int>(picture.width), 0,
                      static_cast<int>(picture.height), TJPF_RGB, &bytes, &size, sampling, 100,
                      flags) == 0);
  std::string made(reinterpret_cast<const char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(encoder);
  return made;
}

/// The vertex colours of a mesh file whose only channels are colours without alpha.
inline std::vector<std::array<float, 3>> colours_of(const std::filesystem::path& path,
                                                    const OpenOptions& options = {
                                                        .textures = Textures::bake}) {
  const auto source = open_mesh(path, options);
  REQUIRE(source->info().channels.size() == 3);
  std::vector<std::array<float, 3>> made;
  source->scan_channels([&](const ChannelPoints& batch) {
    for (std::size_t i = 0; i < batch.values.size(); i += 3) {
      made.push_back({batch.values[i], batch.values[i + 1], batch.values[i + 2]});
    }
  });
  CHECK(made.size() == source->info().vertices);
  return made;
}

}  // namespace meshfarm::test
