// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "texture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "srgb.hpp"

namespace meshfarm {
namespace {

/// Large triangles are sampled on a lattice: about this many texels at most.
constexpr double k_most_samples = 4096;
/// A third with fewer texels is interpolated instead.
constexpr std::uint32_t k_least_samples = 3;
constexpr double k_farthest = 1 << 30;  // in texels

struct Point {
  double x = 0;
  double y = 0;
};
using Corners = std::array<Point, 3>;

/// The texel of `size` that is shown at `at`.
std::uint32_t wrapped(std::int64_t at, std::uint32_t size, TextureWrap wrap) {
  const std::int64_t count = size;
  if (at >= 0 && at < count) return static_cast<std::uint32_t>(at);
  const auto modulo = [at](std::int64_t period) { return (at % period + period) % period; };
  std::int64_t made = 0;
  switch (wrap) {
    case TextureWrap::repeat:
      made = modulo(count);
      break;
    case TextureWrap::mirror:
      made = modulo(2 * count);
      if (made >= count) made = 2 * count - 1 - made;
      break;
    case TextureWrap::clamp:
      made = std::clamp<std::int64_t>(at, 0, count - 1);
      break;
  }
  return static_cast<std::uint32_t>(made);
}

/// The sum of the texels in a third.
class Third {
 public:
  void add(const std::uint8_t* texel) {
    const std::array<float, 256>& levels = linear_floats();
    for (std::size_t i = 0; i < 3; ++i) sum_[i] += static_cast<double>(levels[texel[i]]);
    ++count_;
  }
  bool is_enough() const { return count_ >= k_least_samples; }
  LinearColour mean() const {
    LinearColour made{};
    for (std::size_t i = 0; i < 3; ++i) made[i] = static_cast<float>(sum_[i] / count_);
    return made;
  }

 private:
  std::array<double, 3> sum_{};
  std::uint32_t count_ = 0;
};

class Sampler {
 public:
  explicit Sampler(const Texture& texture)
      : texture_(texture), width_(texture.picture.width), height_(texture.picture.height) {}

  /// Adds the texels of the triangle to its thirds. `doubled` is twice its signed area.
  void add_texels(const Corners& p, double doubled, std::array<Third, 3>& thirds) const {
    const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto step = lattice(std::abs(doubled) / 2, std::max(bottom - top, right - left));
    for (std::int64_t j = first_of(top, step); static_cast<double>(j) + 0.5 <= bottom; j += step) {
      add_row(p, doubled, {j, step}, thirds);
    }
  }

  /// Interpolated between the four texels around a point.
  LinearColour interpolated(Point at) const {
    const double x = std::floor(at.x - 0.5);
    const double y = std::floor(at.y - 0.5);
    const double right = at.x - 0.5 - x;
    const double below = at.y - 0.5 - y;
    std::array<double, 3> sum{};
    const std::array<float, 256>& levels = linear_floats();
    for (const int dy : {0, 1}) {
      for (const int dx : {0, 1}) {
        const std::uint8_t* texel =
            texel_at(static_cast<std::int64_t>(x) + dx, row_at(static_cast<std::int64_t>(y) + dy));
        const double share = (dx == 1 ? right : 1 - right) * (dy == 1 ? below : 1 - below);
        for (std::size_t i = 0; i < 3; ++i) {
          sum[i] += share * static_cast<double>(levels[texel[i]]);
        }
      }
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
  }

 private:
  struct Row {
    std::int64_t y = 0;
    std::int64_t step = 1;
  };

  /// The spacing of the sampled texels. An odd number reaches all texels of a picture that is
  /// repeated, as the sizes of pictures are mostly even.
  static std::int64_t lattice(double area, double extent) {
    const double wanted = std::max(std::sqrt(area / k_most_samples), extent / k_most_samples);
    const auto step = static_cast<std::int64_t>(std::ceil(wanted));
    return std::max<std::int64_t>(1, step + (step % 2 == 0 ? 1 : 0));
  }
  /// The first texel of the lattice whose centre is not before `start`.
  static std::int64_t first_of(double start, std::int64_t step) {
    const double size = static_cast<double>(step);
    return static_cast<std::int64_t>(std::ceil((start - 0.5) / size)) * step;
  }

  const std::uint8_t* row_at(std::int64_t y) const {
    return texture_.picture.row(wrapped(y, height_, texture_.wrap_v));
  }
  const std::uint8_t* texel_at(std::int64_t x, const std::uint8_t* row) const {
    return row + texture_.picture.step * wrapped(x, width_, texture_.wrap_u);
  }

  void add_row(const Corners& p, double doubled, const Row& row,
               std::array<Third, 3>& thirds) const {
    const double y = static_cast<double>(row.y) + 0.5;
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& a = p[i];
      const Point& b = p[(i + 1) % 3];
      if (a.y == b.y || y < std::min(a.y, b.y) || y > std::max(a.y, b.y)) continue;
      const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (!(left <= right)) return;
    const std::uint8_t* const texels = row_at(row.y);
    for (std::int64_t i = first_of(left, row.step); static_cast<double>(i) + 0.5 <= right;
         i += row.step) {
      const double x = static_cast<double>(i) + 0.5;
      const double a = ((p[1].x - x) * (p[2].y - y) - (p[2].x - x) * (p[1].y - y)) / doubled;
      const double b = ((p[2].x - x) * (p[0].y - y) - (p[0].x - x) * (p[2].y - y)) / doubled;
      const double c = 1 - a - b;
      const std::size_t nearest = a >= b ? (a >= c ? 0 : 2) : (b >= c ? 1 : 2);
      thirds[nearest].add(texel_at(i, texels));
    }
  }

  const Texture& texture_;
  std::uint32_t width_;
  std::uint32_t height_;
};

}  // namespace

std::optional<ThirdColours> average_thirds(const Texture& texture,
                                           const std::array<TexturePoint, 3>& corners) {
  Corners p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = {corners[i].u * texture.picture.width, corners[i].v * texture.picture.height};
    if (!(std::abs(p[i].x) <= k_farthest && std::abs(p[i].y) <= k_farthest)) return std::nullopt;
  }
  const double doubled =
      (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  const Sampler sampler(texture);
  std::array<Third, 3> thirds;
  if (doubled != 0) sampler.add_texels(p, doubled, thirds);
  ThirdColours made{.texels = std::abs(doubled) / 2};
  for (std::size_t i = 0; i < 3; ++i) {
    if (thirds[i].is_enough()) {
      made.corners[i] = thirds[i].mean();
      continue;
    }
    const Point& a = p[(i + 1) % 3];
    const Point& b = p[(i + 2) % 3];
    made.corners[i] = sampler.interpolated(
        {(22 * p[i].x + 7 * (a.x + b.x)) / 36, (22 * p[i].y + 7 * (a.y + b.y)) / 36});
  }
  return made;
}

}  // namespace meshfarm
