// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/picture.hpp"

namespace meshfarm {

struct LevelSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// The sizes of a picture and of its smaller copies, each half the size of the previous one,
/// rounded up, down to one texel.
std::vector<LevelSize> level_sizes(std::uint32_t width, std::uint32_t height);

/// The texels of a picture and its smaller copies, as sRGB. Thread-safe.
class PictureLevels {
 public:
  using Texel = std::array<std::uint8_t, 3>;
  virtual ~PictureLevels() = default;
  /// Its size, then those of its smaller copies.
  virtual const std::vector<LevelSize>& sizes() const = 0;
  /// The texels at (x0, y0), (x1, y0), (x0, y1) and (x1, y1), counted from the upper left corner.
  virtual std::array<Texel, 4> texels(std::size_t level, std::uint32_t x0, std::uint32_t y0,
                                      std::uint32_t x1, std::uint32_t y1) const = 0;
};

/// All in memory: three bytes per texel of the picture, and a third of that for the copies.
class DecodedLevels final : public PictureLevels {
 public:
  explicit DecodedLevels(const Picture& picture);
  const std::vector<LevelSize>& sizes() const override { return sizes_; }
  std::array<Texel, 4> texels(std::size_t level, std::uint32_t x0, std::uint32_t y0,
                              std::uint32_t x1, std::uint32_t y1) const override {
    return {texel(level, x0, y0), texel(level, x1, y0), texel(level, x0, y1), texel(level, x1, y1)};
  }
  /// The texels of a row, from this one on.
  const std::uint8_t* at(std::size_t level, std::uint32_t x, std::uint32_t y) const {
    return levels_[level].data() + 3 * (std::size_t{y} * sizes_[level].width + x);
  }

 private:
  Texel texel(std::size_t level, std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* const found = at(level, x, y);
    return {found[0], found[1], found[2]};
  }
  void add_half();

  std::vector<LevelSize> sizes_;
  std::vector<std::vector<std::uint8_t>> levels_;  // row by row from the top
};

}  // namespace meshfarm
