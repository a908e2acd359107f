// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_looks = 16;  // from each pixel
constexpr int k_turns = 4;           // of a square of pixels, this wide, each looks differently
constexpr std::size_t k_square = std::size_t{k_turns} * k_turns;
constexpr double k_radius = 0.06;  // how far, of the picture's shorter side
constexpr double k_strength = 1.5;

/// Steps to look at, in shares of the radius: a spiral, turned differently for each pixel of a
/// square.
using Looks = std::array<std::array<double, 2>, k_looks>;
std::array<Looks, k_square> spirals() {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::array<Looks, k_square> made{};
  for (std::size_t turn = 0; turn < made.size(); ++turn) {
    const double start = 2 * std::numbers::pi * static_cast<double>(turn * 7 % made.size()) /
                         static_cast<double>(made.size());
    for (std::size_t i = 0; i < k_looks; ++i) {
      const double share = (static_cast<double>(i) + 0.5) / k_looks;
      const double angle = start + golden * static_cast<double>(i);
      made[turn][i] = {share * std::cos(angle), share * std::sin(angle)};
    }
  }
  return made;
}

class Sky {
 public:
  Sky(const Canvas& canvas, const Camera& camera)
      : canvas_(canvas),
        camera_(camera),
        width_(static_cast<int>(canvas.size().width)),
        height_(static_cast<int>(canvas.size().height)),
        looks_(spirals()),
        depths_(std::size_t{canvas.size().width} * canvas.size().height, -1.0F) {}

  std::vector<float> find(unsigned threads) {
    const auto rows = static_cast<std::uint64_t>(height_);
    parallel_for(rows, threads, [&](std::uint64_t y) { find_depths(static_cast<int>(y)); });
    std::vector<float> rough(depths_.size(), 1.0F);
    parallel_for(rows, threads, [&](std::uint64_t y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t at = place(x, static_cast<int>(y));
        if (depths_[at] >= 0) rough[at] = open_at(x, static_cast<int>(y));
      }
    });
    std::vector<float> smooth(depths_.size(), 1.0F);
    parallel_for(rows, threads, [&](std::uint64_t y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t at = place(x, static_cast<int>(y));
        if (depths_[at] >= 0) smooth[at] = smoothed_at(rough, x, static_cast<int>(y));
      }
    });
    return smooth;
  }

 private:
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  /// Of the nearest sample of each pixel, or -1.
  void find_depths(int y) {
    const std::uint32_t side = canvas_.size().side;
    for (int x = 0; x < width_; ++x) {
      Canvas::Sample nearest;
      for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint32_t column = static_cast<std::uint32_t>(x) * side + i % side;
        const std::uint32_t row = static_cast<std::uint32_t>(y) * side + i / side;
        const Canvas::Sample sample = canvas_.at(canvas_.place(column, row));
        if (sample.bits() > nearest.bits()) nearest = sample;
      }
      if (!nearest.empty()) depths_[place(x, y)] = static_cast<float>(nearest.depth());
    }
  }

  Vec3 point(int x, int y) const {
    const double side = canvas_.size().side;
    return camera_.unproject({static_cast<float>((x + 0.5) * side - 0.5),
                              static_cast<float>((y + 0.5) * side - 0.5), depths_[place(x, y)]});
  }

  /// The step to a neighbour along the surface: of both sides the one with less of a step in depth.
  Vec3 slope(Vec3 here, int x, int y, int dx, int dy) const {
    Vec3 best;
    double least = HUGE_VAL;
    for (const int way : {1, -1}) {
      const int nx = x + way * dx;
      const int ny = y + way * dy;
      if (!is_inside(nx, ny) || depths_[place(nx, ny)] < 0) continue;
      const Vec3 step = (point(nx, ny) - here) * way;
      if (std::abs(step.z) >= least) continue;
      least = std::abs(step.z);
      best = step;
    }
    return best;
  }

  float open_at(int x, int y) const {
    const Vec3 here = point(x, y);
    Vec3 normal = cross(slope(here, x, y, 1, 0), slope(here, x, y, 0, -1));
    const double size = length(normal);
    if (!(size > 0)) return 1;
    normal = normal * (1 / size);
    const double radius = std::max(4.0, k_radius * std::min(width_, height_));
    // The same length on the surface as the radius on the picture.
    const int beside = x + 1 < width_ ? x + 1 : x - 1;
    const double unit = length(at_depth_of(x, y, beside) - here);
    double hidden = 0;
    const int turn = y % k_turns * k_turns + x % k_turns;
    for (const auto& [dx, dy] : looks_[static_cast<std::size_t>(turn)]) {
      const int lx = x + static_cast<int>(std::lround(dx * radius));
      const int ly = y + static_cast<int>(std::lround(dy * radius));
      if (!is_inside(lx, ly) || depths_[place(lx, ly)] < 0) continue;
      const Vec3 step = point(lx, ly) - here;
      const double away = length(step);
      if (!(away > 0)) continue;
      const double far = away / (radius * unit);
      const double rise = std::max(0.0, dot(step, normal) / away - 0.08);
      hidden += rise * std::max(0.0, 1 - far * far / 2.25);
    }
    return static_cast<float>(std::clamp(1 - k_strength * hidden / k_looks, 0.0, 1.0));
  }

  /// The place of another column as far away as this one.
  Vec3 at_depth_of(int x, int y, int column) const {
    const double side = canvas_.size().side;
    return camera_.unproject({static_cast<float>((column + 0.5) * side - 0.5),
                              static_cast<float>((y + 0.5) * side - 0.5), depths_[place(x, y)]});
  }

  /// The mean of a square in which all directions are looked in once, of the same surface.
  float smoothed_at(const std::vector<float>& rough, int x, int y) const {
    const float depth = depths_[place(x, y)];
    float sum = 0;
    float weight = 0;
    for (int dy = -k_turns / 2; dy < k_turns / 2; ++dy) {
      for (int dx = -k_turns / 2; dx < k_turns / 2; ++dx) {
        if (!is_inside(x + dx, y + dy)) continue;
        const std::size_t at = place(x + dx, y + dy);
        if (depths_[at] < 0 || std::abs(depths_[at] - depth) > 0.02F) continue;
        sum += rough[at];
        weight += 1;
      }
    }
    return sum / weight;
  }

  const Canvas& canvas_;
  const Camera& camera_;
  int width_;
  int height_;
  std::array<Looks, k_square> looks_;
  std::vector<float> depths_;
};

}  // namespace

std::vector<float> find_open_sky(const Canvas& canvas, const Camera& camera, unsigned threads) {
  return Sky(canvas, camera).find(threads);
}

}  // namespace meshfarm
