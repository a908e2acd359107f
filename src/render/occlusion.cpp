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

constexpr std::size_t k_looks = 16;  // directions per pixel
constexpr int k_turns = 4;           // width of a square of pixels with different rotations
constexpr std::size_t k_square = std::size_t{k_turns} * k_turns;
constexpr double k_radius = 0.06;  // of a look, as a fraction of the picture's shorter side
constexpr double k_reach = 2.25;   // times its square: points farther away are ignored
constexpr double k_strength = 1.5;

/// Offsets of the looks, in pixels: a spiral, rotated differently for each pixel of a square.
using Looks = std::array<std::array<int, 2>, k_looks>;
std::array<Looks, k_square> spirals(double radius) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::array<Looks, k_square> made{};
  for (std::size_t turn = 0; turn < made.size(); ++turn) {
    const double start = 2 * std::numbers::pi * static_cast<double>(turn * 7 % made.size()) /
                         static_cast<double>(made.size());
    for (std::size_t i = 0; i < k_looks; ++i) {
      const double share = (static_cast<double>(i) + 0.5) / k_looks;
      const double angle = start + golden * static_cast<double>(i);
      made[turn][i] = {static_cast<int>(std::lround(share * std::cos(angle) * radius)),
                       static_cast<int>(std::lround(share * std::sin(angle) * radius))};
    }
  }
  return made;
}

constexpr float k_not_known = -1;

class Sky {
 public:
  /// `step`: spacing of the pixels that are computed; those in between get their mean.
  Sky(const Canvas& canvas, const Camera& camera, int step)
      : canvas_(canvas),
        camera_(camera),
        step_(step),
        width_(static_cast<int>(canvas.size().width)),
        height_(static_cast<int>(canvas.size().height)),
        radius_(std::max(4.0, k_radius * std::min(width_, height_))),
        looks_(spirals(radius_)),
        depths_(std::size_t{canvas.size().width} * canvas.size().height, -1.0F) {
    const double side = canvas.size().side;
    for (int x = 0; x < width_; ++x) across_.push_back(camera.across((x + 0.5) * side - 0.5));
    for (int y = 0; y < height_; ++y) along_.push_back(camera.along((y + 0.5) * side - 0.5));
  }

  std::vector<float> find(unsigned threads) {
    const auto rows = static_cast<std::uint64_t>(height_);
    parallel_for(rows, threads, [&](std::uint64_t y) { find_depths(static_cast<int>(y)); });
    std::vector<float> rough(depths_.size(), k_not_known);
    parallel_for(rows, threads, [&](std::uint64_t y) {
      if (y % static_cast<std::uint64_t>(step_) != 0) return;
      for (int x = 0; x < width_; x += step_) {
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
  /// Finds the depth of each pixel's nearest sample, or -1.
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

  Vec3 point(int x, int y) const { return at_depth_of(x, y, x); }
  /// The point in another column at this pixel's depth.
  Vec3 at_depth_of(int x, int y, int column) const {
    return camera_.unproject(across_[static_cast<std::size_t>(column)],
                             along_[static_cast<std::size_t>(y)], depths_[place(x, y)]);
  }

  /// The step to a neighbour along the surface: of the two sides, the one with less change of
  /// depth.
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
    // The length on the surface that corresponds to the radius on the picture.
    const int beside = x + 1 < width_ ? x + 1 : x - 1;
    const double unit = length(at_depth_of(x, y, beside) - here);
    const double reach = radius_ * unit;
    const double farthest = k_reach * reach * reach;
    double hidden = 0;
    const int turn = y / step_ % k_turns * k_turns + x / step_ % k_turns;
    for (const auto& [dx, dy] : looks_[static_cast<std::size_t>(turn)]) {
      const int lx = x + dx;
      const int ly = y + dy;
      if (!is_inside(lx, ly) || depths_[place(lx, ly)] < 0) continue;
      const Vec3 step = point(lx, ly) - here;
      const double above = dot(step, normal);
      const double squared = dot(step, step);
      if (!(above > 0) || !(squared < farthest)) continue;  // most looks hide nothing
      const double rise = std::max(0.0, above / std::sqrt(squared) - 0.08);
      hidden += rise * (1 - squared / farthest);
    }
    return static_cast<float>(std::clamp(1 - k_strength * hidden / k_looks, 0.0, 1.0));
  }

  /// The mean over a square that contains each rotation once, on the same surface.
  float smoothed_at(const std::vector<float>& rough, int x, int y) const {
    const float depth = depths_[place(x, y)];
    float sum = 0;
    float weight = 0;
    const int first_x = x / step_ * step_ - k_turns / 2 * step_;
    const int first_y = y / step_ * step_ - k_turns / 2 * step_;
    for (int ny = first_y; ny < first_y + k_turns * step_; ny += step_) {
      for (int nx = first_x; nx < first_x + k_turns * step_; nx += step_) {
        if (!is_inside(nx, ny)) continue;
        const std::size_t at = place(nx, ny);
        if (rough[at] < 0 || std::abs(depths_[at] - depth) > 0.02F) continue;
        sum += rough[at];
        weight += 1;
      }
    }
    return weight > 0 ? sum / weight : open_at(x, y);
  }

  const Canvas& canvas_;
  const Camera& camera_;
  int step_;
  int width_;
  int height_;
  double radius_;  // in pixels
  std::array<Looks, k_square> looks_;
  std::vector<float> depths_;
  std::vector<double> across_;  // of the columns' centres, see Camera
  std::vector<double> along_;   // of the rows'
};

}  // namespace

std::vector<float> find_open_sky(const Canvas& canvas, const Camera& camera,
                                 const RenderOptions& options) {
  return Sky(canvas, camera, options.quick ? 2 : 1).find(options.threads);
}

}  // namespace meshfarm
