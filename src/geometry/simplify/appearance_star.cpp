// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/appearance_star.hpp"

#include <algorithm>

namespace meshfarm {
Quadric AppearanceStar::quadric() const {
  if (is_even_) return {};
  const auto one_over = static_cast<float>(1 / area_);
  return {sum(xx_ - gx_ * gx_ * one_over), sum(xy_ - gx_ * gy_ * one_over),
          sum(xz_ - gx_ * gz_ * one_over), sum(yy_ - gy_ * gy_ * one_over),
          sum(yz_ - gy_ * gz_ * one_over), sum(zz_ - gz_ * gz_ * one_over)};
}

void AppearanceStar::add_to(EdgeQuadric& edge) const {
  if (is_even_) return;
  const auto one_over = static_cast<float>(1 / area_);
  edge.a = edge.a + quadric();
  edge.b = edge.b - Vec3{sum(hx_ - height_ * gx_ * one_over), sum(hy_ - height_ * gy_ * one_over),
                         sum(hz_ - height_ * gz_ * one_over)};
  edge.c += std::max(0.0F, sum(hh_ - height_ * height_ * one_over));
}

Appearance AppearanceStar::at(Vec3 x) const {
  if (is_even_) return base_;
  const Four mean = (gx_ * static_cast<float>(x.x) + gy_ * static_cast<float>(x.y) +
                     gz_ * static_cast<float>(x.z) + height_);
  const double one_over = 1 / (area_ * unit_);
  Appearance made{};
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double number = 0.5 + base_[i] + mean[i] * one_over;
    if (number > 0) made[i] = static_cast<std::uint16_t>(std::min(number, k_range));
  }
  return made;
}

}  // namespace meshfarm
