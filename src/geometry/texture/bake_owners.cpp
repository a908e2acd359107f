// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/texture/bake_owners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace meshfarm {
namespace {

constexpr auto k_squared_touch = static_cast<float>(k_touch_texels * k_touch_texels);

Flat nearest_on_side(Flat p, Flat a, Flat b) {
  const Flat side = b - a;
  const double all = dot(side, side);
  return all > 0 ? a + side * std::clamp(dot(p - a, side) / all, 0.0, 1.0) : a;
}

double squared_between(Flat p, Flat q) {
  return dot(p - q, p - q);
}

}  // namespace

TexelWindow TexelWindow::grown(std::uint32_t texels, std::uint32_t side) const {
  return {x0 - std::min(x0, texels), y0 - std::min(y0, texels), std::min(side, x1 + texels),
          std::min(side, y1 + texels)};
}

Flat nearest_point(Flat p, const FlatTriangle& t) {
  const bool has_area = doubled_area(t) > 0;
  if (has_area && cross(t[1] - t[0], p - t[0]) >= 0 && cross(t[2] - t[1], p - t[1]) >= 0 &&
      cross(t[0] - t[2], p - t[2]) >= 0) {
    return p;
  }
  Flat best = t[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat on_side = nearest_on_side(p, t[k], t[(k + 1) % 3]);
    if (squared_between(p, on_side) < squared_between(p, best)) best = on_side;
  }
  return best;
}

TexelOwners::TexelOwners(std::span<const FlatTriangle> triangles,
                         std::span<const std::uint32_t> chosen, const TexelWindow& window,
                         std::uint32_t margin)
    : triangles_(triangles), window_(window), owners_(window.texels(), k_no_owner) {
  std::vector<float> apart(owners_.size(), std::numeric_limits<float>::infinity());
  for (const std::uint32_t triangle : chosen) claim(triangle, apart);
  for (std::uint32_t i = 0; i < margin; ++i) grow();
}

/// `apart`: the squared distances of the texels to their owners.
void TexelOwners::claim(std::uint32_t triangle, std::vector<float>& apart) {
  const FlatTriangle& t = triangles_[triangle];
  FlatBox box;
  box.add(t);
  const auto texel = [](double x, std::uint32_t lo, std::uint32_t hi) {
    return static_cast<std::uint32_t>(
        std::clamp(x, static_cast<double>(lo), static_cast<double>(hi)));
  };
  const std::uint32_t x0 = texel(box.lo.x - k_touch_texels, window_.x0, window_.x1);
  const std::uint32_t x1 = texel(box.hi.x + k_touch_texels + 1, window_.x0, window_.x1);
  const std::uint32_t y0 = texel(box.lo.y - k_touch_texels, window_.y0, window_.y1);
  const std::uint32_t y1 = texel(box.hi.y + k_touch_texels + 1, window_.y0, window_.y1);
  for (std::uint32_t y = y0; y < y1; ++y) {
    for (std::uint32_t x = x0; x < x1; ++x) {
      const std::size_t at = window_.index(x, y);
      if (apart[at] <= 0) continue;
      const Flat p{x + 0.5, y + 0.5};
      const auto squared = static_cast<float>(squared_between(p, nearest_point(p, t)));
      if (squared > k_squared_touch || !(squared < apart[at])) continue;
      apart[at] = squared;
      owners_[at] = triangle;
    }
  }
}

void TexelOwners::grow() {
  const std::vector<std::uint32_t> before = owners_;
  for (std::uint32_t y = window_.y0; y < window_.y1; ++y) {
    for (std::uint32_t x = window_.x0; x < window_.x1; ++x) {
      const std::size_t at = window_.index(x, y);
      if (before[at] == k_no_owner) owners_[at] = nearest_owner(x, y, before);
    }
  }
}

/// The nearest of the owners of the eight texels round this one.
std::uint32_t TexelOwners::nearest_owner(std::uint32_t x, std::uint32_t y,
                                         const std::vector<std::uint32_t>& owners) const {
  const Flat p{x + 0.5, y + 0.5};
  const std::uint32_t x0 = std::max(x, window_.x0 + 1) - 1, x1 = std::min(x + 2, window_.x1);
  const std::uint32_t y0 = std::max(y, window_.y0 + 1) - 1, y1 = std::min(y + 2, window_.y1);
  std::pair<double, std::uint32_t> best{HUGE_VAL, k_no_owner};
  for (std::uint32_t j = y0; j < y1; ++j) {
    for (std::uint32_t i = x0; i < x1; ++i) {
      const std::uint32_t owner = owners[window_.index(i, j)];
      if (owner == k_no_owner || owner == best.second) continue;
      best = std::min(best, {squared_between(p, nearest_point(p, triangles_[owner])), owner});
    }
  }
  return best.second;
}

}  // namespace meshfarm
