// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// First each triangle claims the texels that it touches, band by band of the picture. Then what is
// claimed grows by a texel at a time: a free texel goes to the nearest of its neighbours' owners.
#include "geometry/bake_owners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_band = 32;  // rows
/// A triangle that touches a texel is within this of its centre: half of its diagonal.
constexpr double k_touch = 0.7072;

Flat nearest_on_side(Flat p, Flat a, Flat b) {
  const Flat side = b - a;
  const double all = dot(side, side);
  return all > 0 ? a + side * std::clamp(dot(p - a, side) / all, 0.0, 1.0) : a;
}

double squared_between(Flat p, Flat q) {
  return dot(p - q, p - q);
}

struct Rows {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

class Claims {
 public:
  Claims(std::span<const FlatTriangle> triangles, const OwnerOptions& options)
      : triangles_(triangles), options_(options), bands_((options.side + k_band - 1) / k_band) {
    owners_.side = options.side;
    owners_.triangles.assign(std::size_t{options.side} * options.side, k_no_owner);
  }

  TexelOwners run() {
    sort_into_bands();
    std::vector<std::uint64_t> covered(bands_, 0);
    parallel_for(bands_, options_.threads, [&](std::uint64_t band) {
      covered[band] = claim(static_cast<std::uint32_t>(band));
    });
    for (const std::uint64_t count : covered) owners_.covered += count;
    for (std::uint32_t i = 0; i < options_.margin; ++i) grow();
    return std::move(owners_);
  }

 private:
  std::uint32_t texel(double x) const {
    return static_cast<std::uint32_t>(std::clamp(x, 0.0, options_.side - 1.0));
  }
  Rows rows_of(std::uint32_t band) const {
    return {band * k_band, std::min(options_.side, (band + 1) * k_band)};
  }

  template <typename Take>
  void for_bands(const Take& take) const {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      FlatBox box;
      box.add(triangles_[t]);
      const std::uint32_t last = texel(box.hi.y + k_touch) / k_band;
      for (std::uint32_t b = texel(box.lo.y - k_touch) / k_band; b <= last; ++b) take(b, t);
    }
  }
  void sort_into_bands() {
    first_.assign(bands_ + std::size_t{2}, 0);
    for_bands([this](std::uint32_t band, std::uint32_t) { ++first_[band + std::size_t{2}]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    in_band_.resize(first_.back());
    for_bands([this](std::uint32_t band, std::uint32_t t) {
      in_band_[first_[band + std::size_t{1}]++] = t;
    });
  }

  /// Returns how many texels of the band are touched.
  std::uint64_t claim(std::uint32_t band) {
    const Rows rows = rows_of(band);
    std::vector<float> apart(std::size_t{rows.end - rows.begin} * options_.side,
                             std::numeric_limits<float>::infinity());
    for (std::size_t i = first_[band]; i < first_[band + std::size_t{1}]; ++i) {
      claim_by(in_band_[i], rows, apart);
    }
    return static_cast<std::uint64_t>(
        std::count_if(apart.begin(), apart.end(), [](float x) { return x <= k_touch * k_touch; }));
  }

  /// `apart`: the squared distances of the band's texels to their owners.
  void claim_by(std::uint32_t triangle, Rows rows, std::vector<float>& apart) {
    const FlatTriangle& t = triangles_[triangle];
    FlatBox box;
    box.add(t);
    const std::uint32_t x0 = texel(box.lo.x - k_touch), x1 = texel(box.hi.x + k_touch);
    const std::uint32_t y0 = std::max(rows.begin, texel(box.lo.y - k_touch));
    const std::uint32_t y1 = std::min(rows.end - 1, texel(box.hi.y + k_touch));
    for (std::uint32_t y = y0; y <= y1; ++y) {
      float* row = apart.data() + std::size_t{y - rows.begin} * options_.side;
      std::uint32_t* owners = owners_.triangles.data() + std::size_t{y} * options_.side;
      for (std::uint32_t x = x0; x <= x1; ++x) {
        if (row[x] <= 0) continue;
        const Flat p{x + 0.5, y + 0.5};
        const auto squared = static_cast<float>(squared_between(p, nearest_point(p, t)));
        if (squared > static_cast<float>(k_touch * k_touch) || !(squared < row[x])) continue;
        row[x] = squared;
        owners[x] = triangle;
      }
    }
  }

  void grow() {
    const std::vector<std::uint32_t> before = owners_.triangles;
    parallel_for(bands_, options_.threads, [&](std::uint64_t band) {
      const Rows rows = rows_of(static_cast<std::uint32_t>(band));
      for (std::uint32_t y = rows.begin; y < rows.end; ++y) {
        for (std::uint32_t x = 0; x < options_.side; ++x) {
          const std::size_t at = std::size_t{y} * options_.side + x;
          if (before[at] == k_no_owner) owners_.triangles[at] = nearest_owner(x, y, before);
        }
      }
    });
  }

  /// Of the eight texels round this one.
  std::uint32_t nearest_owner(std::uint32_t x, std::uint32_t y,
                              const std::vector<std::uint32_t>& owners) const {
    const Flat p{x + 0.5, y + 0.5};
    const std::uint32_t x0 = x > 0 ? x - 1 : x, x1 = std::min(x + 1, options_.side - 1);
    const std::uint32_t y0 = y > 0 ? y - 1 : y, y1 = std::min(y + 1, options_.side - 1);
    std::pair<double, std::uint32_t> best{HUGE_VAL, k_no_owner};
    for (std::uint32_t j = y0; j <= y1; ++j) {
      for (std::uint32_t i = x0; i <= x1; ++i) {
        const std::uint32_t owner = owners[std::size_t{j} * options_.side + i];
        if (owner == k_no_owner || owner == best.second) continue;
        best = std::min(best, {squared_between(p, nearest_point(p, triangles_[owner])), owner});
      }
    }
    return best.second;
  }

  std::span<const FlatTriangle> triangles_;
  OwnerOptions options_;
  std::uint32_t bands_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> in_band_;  // triangles, band by band
  TexelOwners owners_;
};

}  // namespace

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

TexelOwners texel_owners(std::span<const FlatTriangle> triangles, const OwnerOptions& options) {
  return Claims(triangles, options).run();
}

}  // namespace meshfarm
