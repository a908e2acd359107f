// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/develop.hpp"

#include <array>
#include <cmath>

#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

/// The sum of a pixel's samples.
struct Sum {
  std::uint32_t covered = 0;
  std::array<std::uint32_t, 3> levels{};

  void add(const Srgb& colour) {
    ++covered;
    for (std::size_t i = 0; i < 3; ++i) levels[i] += colour[i];
  }
};

constexpr std::uint32_t rounded_ratio(std::uint32_t a, std::uint32_t b) {
  return (2 * a + b) / (2 * b);
}

Sum sum_of(const Canvas& canvas, std::uint32_t x, std::uint32_t y, float root_of_light) {
  const std::uint32_t side = canvas.size().side;
  Sum sum;
  for (std::uint32_t row = y * side; row < (y + 1) * side; ++row) {
    for (std::uint32_t column = x * side; column < (x + 1) * side; ++column) {
      const Canvas::Sample sample = canvas.at(canvas.place(column, row));
      if (sample.empty()) continue;
      sum.add(root_of_light == 1 ? sample.colour() : dimmed(sample.colour(), root_of_light));
    }
  }
  return sum;
}

}  // namespace

Texels develop(const Canvas& canvas, const std::vector<float>& open_sky,
               const RenderOptions& options) {
  const Canvas::Size& size = canvas.size();
  const std::uint32_t all = size.side * size.side;
  Texels picture{.width = size.width, .height = size.height, .step = options.transparent ? 4U : 3U};
  picture.bytes.resize(picture.step * picture.width * picture.height);
  parallel_for(size.height, options.threads, [&](std::uint64_t row) {
    const auto y = static_cast<std::uint32_t>(row);
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const float light = open_sky.empty() ? 1 : open_sky[row * size.width + x];
      const Sum sum = sum_of(canvas, x, y, std::sqrt(light));
      std::uint8_t* texel = picture.at(x, y);
      const std::uint32_t parts = options.transparent ? sum.covered : all;
      for (std::size_t i = 0; i < 3 && parts > 0; ++i) {
        const std::uint32_t under = (parts - sum.covered) * options.background[i];
        texel[i] = static_cast<std::uint8_t>(rounded_ratio(sum.levels[i] + under, parts));
      }
      if (options.transparent) {
        texel[3] = static_cast<std::uint8_t>(rounded_ratio(255 * sum.covered, all));
      }
    }
  });
  return picture;
}

}  // namespace meshfarm
