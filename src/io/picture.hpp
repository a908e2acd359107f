// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace meshfarm {

/// The properties of a PNG or JPEG, from its header.
struct PictureHead {
  enum class Kind : std::uint8_t { png, jpeg };
  Kind kind = Kind::png;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool has_alpha = false;
  bool is_progressive = false;

  /// The memory that decode_picture() takes beside the file's bytes.
  std::uint64_t memory_bytes() const;
};

/// Texels of a picture as sRGB, row by row from the top.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::size_t step = 3;  // bytes per texel; the first three are red, green and blue
  std::vector<std::uint8_t> texels;
  std::string oddity;  // a tolerated oddity; a line for the user

  const std::uint8_t* row(std::uint32_t y) const {
    return texels.data() + std::size_t{y} * width * step;
  }
};

/// The largest side and the most texels of a picture that is read.
inline constexpr std::uint32_t k_most_picture_side = 65'535;
inline constexpr std::uint64_t k_most_texels = std::uint64_t{1} << 30;

/// Reads the header of a PNG or JPEG, from the file's first bytes or all of them. Throws DataError
/// for another format, a malformed header, or a picture larger than the above.
PictureHead read_picture_head(std::string_view bytes);

/// Decodes a PNG or JPEG to 8 bits a level. Colour profiles, gamma and orientation are ignored, as
/// in glTF. Throws DataError for a damaged picture, or one that is neither grey nor RGB.
Picture decode_picture(std::string bytes);

}  // namespace meshfarm
