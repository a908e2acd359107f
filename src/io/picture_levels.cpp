// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "io/picture_levels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/srgb.hpp"

namespace meshfarm {

std::vector<LevelSize> level_sizes(std::uint32_t width, std::uint32_t height) {
  std::vector<LevelSize> sizes = {{width, height}};
  while (std::max(width, height) > 1) {
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    sizes.push_back({width, height});
  }
  return sizes;
}

DecodedLevels::DecodedLevels(const Picture& picture)
    : sizes_(level_sizes(picture.width, picture.height)) {
  std::vector<std::uint8_t> first(3 * std::size_t{picture.width} * picture.height);
  std::uint8_t* out = first.data();
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    const std::uint8_t* in = picture.row(y);
    for (std::uint32_t x = 0; x < picture.width; ++x, in += picture.step, out += 3) {
      std::copy_n(in, 3, out);
    }
  }
  levels_.push_back(std::move(first));
  while (levels_.size() < sizes_.size()) add_half();
}

/// Half the size of the last in each direction, each texel the mean of up to four.
void DecodedLevels::add_half() {
  const std::size_t from = levels_.size() - 1;
  const LevelSize fine = sizes_[from];
  const LevelSize size = sizes_[from + 1];
  std::vector<std::uint8_t> made(3 * std::size_t{size.width} * size.height);
  const auto& linear = linear_floats();
  std::size_t next = 0;
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const std::uint32_t right = std::min(2 * x + 1, fine.width - 1);
      const std::uint32_t below = std::min(2 * y + 1, fine.height - 1);
      const auto four = texels(from, 2 * x, 2 * y, right, below);
      for (std::size_t c = 0; c < 3; ++c) {
        const float sum =
            (linear[four[0][c]] + linear[four[1][c]]) + (linear[four[2][c]] + linear[four[3][c]]);
        const double level = srgb_of_linear(0.25 * static_cast<double>(sum));
        made[next++] = static_cast<std::uint8_t>(std::lround(level * 255));
      }
    }
  }
  levels_.push_back(std::move(made));
}

}  // namespace meshfarm
