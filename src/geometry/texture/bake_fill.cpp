// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Pull-push (Gortler et al., The Lumigraph, 1996, section 3.4): means are pulled up a pyramid of
// pictures, each with half the side length, and pushed down again to where there was nothing.
#include "geometry/texture/bake_fill.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

using Texel = std::array<std::uint8_t, 3>;

struct Level {
  std::uint32_t side = 0;
  std::vector<Texel> texels;
  std::vector<std::uint8_t> is_set;

  std::size_t at(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * side + x; }
};

constexpr std::uint32_t k_rows = 16;

template <typename Work>
void for_rows(std::uint32_t rows, unsigned threads, const Work& work) {
  parallel_for((rows + k_rows - 1) / k_rows, threads, [&](std::uint64_t chunk) {
    const auto begin = static_cast<std::uint32_t>(chunk * k_rows);
    for (std::uint32_t y = begin; y < std::min(rows, begin + k_rows); ++y) work(y);
  });
}

Level half_of(const Level& fine, unsigned threads) {
  Level made{(fine.side + 1) / 2, {}, {}};
  made.texels.resize(std::size_t{made.side} * made.side);
  made.is_set.resize(made.texels.size());
  for_rows(made.side, threads, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < made.side; ++x) {
      std::array<unsigned, 3> sum{};
      unsigned count = 0;
      for (std::uint32_t j = 2 * y; j < std::min(fine.side, 2 * y + 2); ++j) {
        for (std::uint32_t i = 2 * x; i < std::min(fine.side, 2 * x + 2); ++i) {
          if (fine.is_set[fine.at(i, j)] == 0) continue;
          ++count;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += fine.texels[fine.at(i, j)][c];
        }
      }
      if (count == 0) continue;
      made.is_set[made.at(x, y)] = 1;
      for (std::size_t c = 0; c < 3; ++c) {
        made.texels[made.at(x, y)][c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
    }
  });
  return made;
}

/// Interpolates between the centres of the four nearest texels of the coarser level.
Texel blend_at(const Level& coarse, std::uint32_t x, std::uint32_t y) {
  const auto beside = [&coarse](std::uint32_t at) {
    const std::uint32_t half = at / 2;
    if (at % 2 == 1) return std::min(half + 1, coarse.side - 1);
    return half > 0 ? half - 1 : 0;
  };
  const std::uint32_t near_x = x / 2, near_y = y / 2;
  const Texel& a = coarse.texels[coarse.at(near_x, near_y)];
  const Texel& b = coarse.texels[coarse.at(beside(x), near_y)];
  const Texel& c = coarse.texels[coarse.at(near_x, beside(y))];
  const Texel& d = coarse.texels[coarse.at(beside(x), beside(y))];
  Texel made;
  for (std::size_t i = 0; i < 3; ++i) {
    made[i] = static_cast<std::uint8_t>((9U * a[i] + 3U * b[i] + 3U * c[i] + d[i] + 8U) / 16U);
  }
  return made;
}

void push_down(const Level& coarse, Level& fine, unsigned threads) {
  for_rows(fine.side, threads, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < fine.side; ++x) {
      if (fine.is_set[fine.at(x, y)] == 0) fine.texels[fine.at(x, y)] = blend_at(coarse, x, y);
    }
  });
}

}  // namespace

void fill_texels(std::vector<Texel>& texels, std::vector<std::uint8_t>& is_set, std::uint32_t side,
                 unsigned threads) {
  std::vector<Level> levels(1);
  levels[0] = {side, std::move(texels), std::move(is_set)};
  while (levels.back().side > 1) levels.push_back(half_of(levels.back(), threads));
  if (levels.back().is_set[0] == 0) levels.back().texels[0] = {128, 128, 128};
  for (std::size_t i = levels.size() - 1; i-- > 0;) push_down(levels[i + 1], levels[i], threads);
  texels = std::move(levels[0].texels);
  is_set = std::move(levels[0].is_set);
}

}  // namespace meshfarm
