// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Shapes are let down, the largest first, onto a horizon: the top of what lies in each column. Each
// goes where it comes to lie lowest and leaves least room below it, turned as is best for that
// (Levy et al., Least Squares Conformal Maps, 2002, section 4).
#include "geometry/atlas_pack.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace meshfarm {
namespace {

using Height = std::int16_t;  // texels: a picture has at most 16,384 a side

/// A shape with its margins, in one turn: for each column of some texels the range that it takes.
struct Profile {
  std::vector<Height> low;
  std::vector<Height> high;
  long low_sum = 0;
  Height top = 0;
};

struct Raster {
  double scale;
  std::uint32_t margin;
  std::uint32_t column;  // texels a column
};

class ShapeProfiles {
 public:
  /// False if the shape is larger than the picture.
  bool measure(const PackShape& shape, const Raster& raster, std::uint32_t side) {
    raster_ = raster;
    const double wide = shape.size.x * raster.scale + 2 * raster.margin;
    const double high = shape.size.y * raster.scale + 2 * raster.margin;
    if (!(wide <= side && high <= side)) return false;
    const std::size_t columns = blocks(wide), rows = blocks(high);
    width_ = static_cast<int>(columns * raster.column);
    height_ = static_cast<int>(rows * raster.column);
    clear(by_x_, columns);
    clear(by_y_, rows);
    for (const auto& [a, b] : shape.outline) {
      const Flat from = a * raster.scale, to = b * raster.scale;
      add_side(from, to, by_x_);
      add_side({from.y, from.x}, {to.y, to.x}, by_y_);
    }
    return true;
  }
  int width() const { return width_; }
  int height() const { return height_; }

  void turn(int quarters, Profile& to) const {
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

 private:
  std::size_t blocks(double texels) const {
    return static_cast<std::size_t>(std::ceil(std::max(texels, 1.0) / raster_.column));
  }
  static void clear(Profile& profile, std::size_t columns) {
    profile.low.assign(columns, std::numeric_limits<Height>::max());
    profile.high.assign(columns, 0);
  }

  /// All that is within the margin of a side, by its two axes alone.
  void add_side(Flat a, Flat b, Profile& to) const {
    if (a.x > b.x) std::swap(a, b);
    const double margin = raster_.margin, column = raster_.column;
    const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
    const auto last =
        std::min(to.low.size() - 1, static_cast<std::size_t>((b.x + 2 * margin) / column));
    for (auto i = std::min(last, static_cast<std::size_t>(a.x / column)); i <= last; ++i) {
      const double lo = std::clamp(static_cast<double>(i) * column - 2 * margin, a.x, b.x);
      const double hi = std::clamp((static_cast<double>(i) + 1) * column, a.x, b.x);
      double y0 = a.y + (lo - a.x) * slope, y1 = a.y + (hi - a.x) * slope;
      if (lo == a.x && hi == b.x) y0 = a.y, y1 = b.y;
      const double least = std::max(0.0, std::min(y0, y1));
      const double most = std::max(y0, y1) + 2 * margin;
      to.low[i] = std::min(to.low[i], static_cast<Height>(least));
      to.high[i] = std::max(to.high[i], static_cast<Height>(std::ceil(most)));
    }
  }

  Raster raster_{};
  int width_ = 0, height_ = 0;
  Profile by_x_, by_y_;
};

class Horizon {
 public:
  /// Hasty: narrow shapes are looked for only round where the horizon is lowest.
  Horizon(std::uint32_t side, std::uint32_t column, bool is_hasty)
      : side_(static_cast<int>(side)),
        is_hasty_(is_hasty),
        top_(side / column, 0),
        blocks_((top_.size() + k_block - 1) / k_block, 0),
        rest_(top_.size()) {}

  struct Spot {
    double score = HUGE_VAL;
    std::size_t column = 0;
    int y = 0;
  };

  /// Where the shape lies best.
  Spot best_spot(const Profile& shape) {
    const std::size_t width = shape.low.size();
    if (width > top_.size()) return {};
    const std::size_t places = top_.size() - width + 1;
    if (is_hasty_ && 2 * width < k_window && places > 2 * k_window) {
      const std::size_t lowest = lowest_block() * k_block;
      const std::size_t begin =
          std::min(lowest - std::min(lowest, k_window / 2), places - k_window);
      const Spot spot = best_between(shape, begin, begin + k_window);
      if (spot.score < HUGE_VAL) return spot;
    }
    return best_between(shape, 0, places);
  }

  void put(const Profile& shape, const Spot& spot) {
    for (std::size_t c = 0; c < shape.high.size(); ++c) {
      top_[spot.column + c] = static_cast<Height>(spot.y + shape.high[c]);
    }
    const std::size_t end = spot.column + shape.high.size();
    for (std::size_t b = spot.column / k_block; b * k_block < end; ++b) set_block(b);
  }

 private:
  static constexpr std::size_t k_block = 16;   // columns of which the lowest is known
  static constexpr std::size_t k_window = 64;  // columns

  void set_block(std::size_t block) {
    const auto begin = top_.begin() + static_cast<long>(block * k_block);
    const auto end = top_.end() - begin > static_cast<long>(k_block) ? begin + k_block : top_.end();
    blocks_[block] = *std::min_element(begin, end);
  }
  std::size_t lowest_block() const {
    return static_cast<std::size_t>(std::min_element(blocks_.begin(), blocks_.end()) -
                                    blocks_.begin());
  }

  /// Of the first columns begin to end.
  Spot best_between(const Profile& shape, std::size_t begin, std::size_t end) {
    const std::size_t width = shape.low.size();
    const std::size_t places = end - begin;
    std::fill_n(rest_.begin(), places, Height{0});
    for (std::size_t c = 0; c < width; ++c) {
      const Height* top = top_.data() + begin + c;
      const Height low = shape.low[c];
      Height* rest = rest_.data();
      for (std::size_t x = 0; x < places; ++x) {
        const auto y = static_cast<Height>(top[x] - low);
        rest[x] = rest[x] < y ? y : rest[x];
      }
    }
    const auto first = top_.begin() + static_cast<long>(begin);
    long below = std::accumulate(first, first + static_cast<long>(width), 0L);
    const double columns = static_cast<double>(width);
    Spot best;
    for (std::size_t x = 0; x < places; ++x) {
      const int y = rest_[x];
      if (y + shape.top <= side_) {
        const double lost = static_cast<double>(shape.low_sum - below) / columns + y;
        const double score = k_height_weight * (y + shape.top) + lost;
        if (score < best.score) best = {score, begin + x, y};
      }
      if (x + 1 < places)
        below += first[static_cast<long>(x + width)] - first[static_cast<long>(x)];
    }
    return best;
  }

  static constexpr double k_height_weight = 1;
  int side_;
  bool is_hasty_;
  std::vector<Height> top_;
  std::vector<Height> blocks_;  // the lowest of each
  std::vector<Height> rest_;    // where the shape would lie, for each first column
};

class Packer {
 public:
  Packer(std::span<const PackShape> shapes, const PackOptions& options)
      : shapes_(shapes), options_(options), order_(shapes.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return longest(shapes[a]) > longest(shapes[b]);
    });
  }

  Packing run() {
    std::optional<Packing> made;
    for (std::uint32_t margin = options_.margin;; margin /= 2) {
      made = best_with(margin);
      const bool is_worth_it = made && share_of(made->scale) >= k_least_share;
      if (is_worth_it || margin == 0 || (made && margin == 1)) break;
    }
    return made ? *made : heaped();
  }

 private:
  /// Of the picture, that shapes must have for their margins to be kept.
  static constexpr double k_least_share = 0.1;
  static constexpr double k_close_enough = 1.004;
  /// Steps of the inner loop for one trial.
  static constexpr double k_most_work = 4e8;
  static constexpr std::uint32_t k_widest_column = 4;
  static constexpr std::size_t k_many = 8000;

  static double longest(const PackShape& shape) { return std::max(shape.size.x, shape.size.y); }
  double side() const { return options_.side; }
  double share_of(double scale) const { return scale * scale * options_.area / (side() * side()); }

  /// The scale at which the boxes with their margins have a share of the picture.
  double scale_at_share(std::uint32_t margin, double share) const {
    double low = 0, high = 2 * side() / std::sqrt(options_.area);
    for (int i = 0; i < 50; ++i) {
      const double scale = (low + high) / 2;
      double all = 0;
      for (const PackShape& shape : shapes_) {
        all += (shape.size.x * scale + 2 * margin) * (shape.size.y * scale + 2 * margin);
      }
      (all > share * side() * side() ? high : low) = scale;
    }
    return low;
  }

  std::optional<Packing> best_with(std::uint32_t margin) const {
    const double least_side = std::max(1.0, 2.0 * margin);
    if (static_cast<double>(shapes_.size()) * least_side * least_side > side() * side()) return {};
    double fails = scale_at_share(margin, 1) * 1.5;
    double scale = scale_at_share(margin, 0.9);
    std::optional<Packing> best;
    for (double step = 1.06; !best; step *= step) {
      best = pack_at(scale, margin);
      if (best) break;
      fails = scale;
      scale /= step;
      if (step > 1e6) return {};
    }
    for (double step = 1.03; best->scale * step < fails; step *= step) {
      auto next = pack_at(best->scale * step, margin);
      if (!next) {
        fails = best->scale * step;
        break;
      }
      best = std::move(next);
    }
    while (fails > best->scale * k_close_enough) {
      const double middle = (fails + best->scale) / 2;
      auto next = pack_at(middle, margin);
      if (next) {
        best = std::move(next);
      } else {
        fails = middle;
      }
    }
    return best;
  }

  std::uint32_t column_for(double scale, std::uint32_t margin) const {
    double lengths = 0;
    for (const PackShape& shape : shapes_) {
      lengths += (shape.size.x + shape.size.y) * scale + 4 * margin;
    }
    const double work = lengths * 2 * side();
    std::uint32_t column = 1;
    while (work / (column * column) > k_most_work && column < k_widest_column) column *= 2;
    return column;
  }

  std::optional<Packing> pack_at(double scale, std::uint32_t margin) const {
    const Raster raster{scale, margin, column_for(scale, margin)};
    if (raster.column > options_.side) return {};
    Horizon horizon(options_.side, raster.column, shapes_.size() > k_many);
    Packing made{scale, margin, std::vector<PackPlace>(shapes_.size())};
    ShapeProfiles profiles;
    Profile now, chosen;
    for (const std::uint32_t i : order_) {
      if (!profiles.measure(shapes_[i], raster, options_.side)) return {};
      Horizon::Spot best;
      int best_turn = 0;
      for (int turn = 0; turn < 4; ++turn) {
        profiles.turn(turn, now);
        const Horizon::Spot spot = horizon.best_spot(now);
        if (!(spot.score < best.score)) continue;
        best = spot;
        best_turn = turn;
        std::swap(chosen, now);
      }
      if (best.score == HUGE_VAL) return {};
      horizon.put(chosen, best);
      made.places[i] = {static_cast<std::uint8_t>(best_turn),
                        static_cast<std::uint16_t>(best.column * raster.column),
                        static_cast<std::uint16_t>(best.y),
                        static_cast<std::uint16_t>(profiles.width()),
                        static_cast<std::uint16_t>(profiles.height())};
    }
    return made;
  }

  /// More shapes than texels: each lies in one, several in some.
  Packing heaped() const {
    double largest = 0;
    for (const PackShape& shape : shapes_) largest = std::max(largest, longest(shape));
    Packing made{largest > 0 ? 1 / largest : 0, 0, std::vector<PackPlace>(shapes_.size())};
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const std::size_t cell = i % (std::size_t{options_.side} * options_.side);
      made.places[i] = {0, static_cast<std::uint16_t>(cell % options_.side),
                        static_cast<std::uint16_t>(cell / options_.side), 1, 1};
    }
    return made;
  }

  std::span<const PackShape> shapes_;
  PackOptions options_;
  std::vector<std::uint32_t> order_;  // the longest first
};

}  // namespace

Flat Packing::placed(Flat p, const PackPlace& place) const {
  const double x = p.x * scale + margin, y = p.y * scale + margin;
  const Flat at{static_cast<double>(place.x), static_cast<double>(place.y)};
  switch (place.quarter_turns) {
    case 1:
      return at + Flat{place.height - y, x};
    case 2:
      return at + Flat{place.width - x, place.height - y};
    case 3:
      return at + Flat{y, place.width - x};
    default:
      return at + Flat{x, y};
  }
}

Packing pack_shapes(std::span<const PackShape> shapes, const PackOptions& options) {
  return Packer(shapes, options).run();
}

}  // namespace meshfarm
