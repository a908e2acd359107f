// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstring>

#include "io/texture.hpp"
#include "mesh_fuzzer.hpp"

// Any texture coordinates on a small picture give levels of its texels, in bounded time.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  std::array<TexturePoint, 3> corners;
  if (size < sizeof corners + 2) return -1;
  std::memcpy(corners.data(), data, sizeof corners);
  const auto wrap = [&](std::size_t at) {
    return static_cast<TextureWrap>(data[sizeof corners + at] % 3);
  };
  Picture picture{.width = 5, .height = 3};
  for (std::uint8_t i = 0; i < 45; ++i) picture.texels.push_back(static_cast<std::uint8_t>(5 * i));
  const auto made = average_thirds({picture, wrap(0), wrap(1)}, corners);
  if (!made) return 0;
  for (const LinearColour& corner : made->corners) {
    for (const float level : corner) fuzz::require(level >= 0 && level <= 1);
  }
  return 0;
}
