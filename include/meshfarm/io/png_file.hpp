// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace meshfarm {

/// A picture's texels as sRGB, row by row from the top.
struct Texels {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::size_t step = 3;  // bytes per texel: red, green and blue, and alpha if there are 4
  std::vector<std::uint8_t> bytes;

  std::uint8_t* at(std::uint32_t x, std::uint32_t y) {
    return bytes.data() + (std::size_t{y} * width + x) * step;
  }
};

/// How a PNG is compressed: as small as possible, or in a third of the time with half as many bytes
/// again.
enum class PngSize : std::uint8_t { least, soon };

/// A PNG file. Throws DataError for a picture that the format cannot hold.
std::string encode_png(Texels texels, PngSize size = PngSize::least);
/// Writes a PNG that appears under its name only when whole. Throws IoError, or DataError for a
/// picture that the format cannot hold.
void write_png(const std::filesystem::path& path, Texels texels);

}  // namespace meshfarm
