// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/texture/flat.hpp"

namespace meshfarm {

inline constexpr std::uint32_t k_no_owner = 0xffffffff;
/// If a triangle touches a texel, it is within this of the texel's centre: half of its diagonal.
inline constexpr double k_touch_texels = 0.7072;

/// A rectangle of texels: from (x0, y0) up to (x1, y1), exclusive.
struct TexelWindow {
  std::uint32_t x0 = 0;
  std::uint32_t y0 = 0;
  std::uint32_t x1 = 0;
  std::uint32_t y1 = 0;

  std::uint32_t width() const { return x1 - x0; }
  std::size_t texels() const { return std::size_t{x1 - x0} * (y1 - y0); }
  /// The index of a texel inside the window.
  std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y - y0} * width() + (x - x0);
  }
  /// Grown by this many texels on each side, as far as the picture goes.
  TexelWindow grown(std::uint32_t texels, std::uint32_t side) const;
};

/// The point of the triangle nearest to p.
Flat nearest_point(Flat p, const FlatTriangle& triangle);

/// From which triangle each texel of a window takes its colour. `chosen`: the triangles to
/// consider, ascending; all that are near must be among them.
class TexelOwners {
 public:
  /// First each triangle claims the texels that it touches; a texel belongs to the triangle that
  /// contains its centre, otherwise to the nearest. Then the claimed area grows by a texel at a
  /// time, `margin` times: a free texel goes to the nearest of its neighbours' owners. Owners less
  /// than `margin` texels inside the window's sides are right only where the picture ends there.
  TexelOwners(std::span<const FlatTriangle> triangles, std::span<const std::uint32_t> chosen,
              const TexelWindow& window, std::uint32_t margin);
  /// The owner of a texel in the window; k_no_owner if no triangle is near.
  std::uint32_t at(std::uint32_t x, std::uint32_t y) const { return owners_[window_.index(x, y)]; }

 private:
  void claim(std::uint32_t triangle, std::vector<float>& apart);
  void grow();
  std::uint32_t nearest_owner(std::uint32_t x, std::uint32_t y,
                              const std::vector<std::uint32_t>& owners) const;

  std::span<const FlatTriangle> triangles_;
  TexelWindow window_;
  std::vector<std::uint32_t> owners_;
};

}  // namespace meshfarm
