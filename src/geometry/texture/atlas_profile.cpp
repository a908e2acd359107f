// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/texture/atlas_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace meshfarm {
namespace {

void clear(Profile& profile, std::size_t columns) {
  profile.low.assign(columns, std::numeric_limits<Height>::max());
  profile.high.assign(columns, 0);
}

}  // namespace

bool ShapeProfiles::measure(const PackShape& shape, const Raster& raster, std::uint32_t side) {
  raster_ = raster;
  const double wide = shape.size.x * raster.scale + 2 * raster.margin;
  const double high = shape.size.y * raster.scale + 2 * raster.margin;
  if (!(wide <= side && high <= side)) return false;
  clear(by_x_, columns(wide));
  clear(by_y_, columns(high));
  width_ = static_cast<int>(by_x_.low.size() * raster.column);
  height_ = static_cast<int>(by_y_.low.size() * raster.column);
  for (const auto& [a, b] : shape.outline) {
    const Flat from = a * raster.scale, to = b * raster.scale;
    add_side(from, to, by_x_);
    add_side({from.y, from.x}, {to.y, to.x}, by_y_);
  }
  return true;
}

void ShapeProfiles::turn(int quarters, Profile& to) const {
  const Profile& from = quarters % 2 == 0 ? by_x_ : by_y_;
  to = from;
  const bool is_reversed = quarters == 1 || quarters == 2;
  const bool is_flipped = quarters >= 2;
  if (is_flipped) {
    const int all = quarters == 2 ? height_ : width_;
    for (std::size_t i = 0; i < to.low.size(); ++i) {
      to.low[i] = static_cast<Height>(all - from.high[i]);
      to.high[i] = static_cast<Height>(all - from.low[i]);
    }
  }
  if (is_reversed) {
    std::reverse(to.low.begin(), to.low.end());
    std::reverse(to.high.begin(), to.high.end());
  }
  to.low_sum = std::accumulate(to.low.begin(), to.low.end(), 0L);
  to.top = *std::max_element(to.high.begin(), to.high.end());
}

std::size_t ShapeProfiles::columns(double texels) const {
  return static_cast<std::size_t>(std::ceil(std::max(texels, 1.0) / raster_.column));
}

/// Adds what is within the margin of a side, measured along the two axes separately.
void ShapeProfiles::add_side(Flat a, Flat b, Profile& to) const {
  if (a.x > b.x) std::swap(a, b);
  const double margin = raster_.margin, column = raster_.column;
  const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
  const auto last =
      std::min(to.low.size() - 1, static_cast<std::size_t>((b.x + 2 * margin) / column));
  for (auto i = std::min(last, static_cast<std::size_t>(a.x / column)); i <= last; ++i) {
    const double lo = std::clamp(static_cast<double>(i) * column - 2 * margin, a.x, b.x);
    const double hi = std::clamp((static_cast<double>(i) + 1) * column, a.x, b.x);
    const bool is_all = lo == a.x && hi == b.x;
    const double y0 = is_all ? a.y : a.y + (lo - a.x) * slope;
    const double y1 = is_all ? b.y : a.y + (hi - a.x) * slope;
    const double least = std::max(0.0, std::min(y0, y1));
    const double most = std::max(y0, y1) + 2 * margin;
    to.low[i] = std::min(to.low[i], static_cast<Height>(least));
    to.high[i] = std::max(to.high[i], static_cast<Height>(std::ceil(most)));
  }
}

}  // namespace meshfarm
