// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Shapes are lowered, the largest first, onto a horizon: the top of what lies in each column. Each
// shape goes where it lies lowest and wastes least room below it, in the best of its four
// orientations (Levy et al., Least Squares Conformal Maps, 2002, section 4).
#include "geometry/texture/atlas_pack.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/texture/atlas_horizon.hpp"

namespace meshfarm {
namespace {

class Packer {
 public:
  Packer(std::span<const PackShape> shapes, const PackOptions& options)
      : shapes_(shapes), options_(options), order_(shapes.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return box_area(shapes[a]) > box_area(shapes[b]);
    });
  }

  Packing run() {
    std::optional<Packing> made;
    for (std::uint32_t margin = options_.margin;; margin /= 2) {
      if (margin > 1 && share_of(scale_at_share(margin, k_usual_fill)) < k_least_share) continue;
      made = best_with(margin);
      const bool is_worth_it = made && share_of(made->scale) >= k_least_share;
      if (is_worth_it || margin == 0 || (made && margin == 1)) break;
    }
    return made ? *made : heaped();
  }

 private:
  /// Least share of the picture that shapes must cover for their margins to be kept.
  static constexpr double k_least_share = 0.1;
  static constexpr double k_close_enough = 1.004;
  /// Approximate share of the picture that boxes cover.
  static constexpr double k_usual_fill = 0.9;
  /// Inner loop steps per trial.
  static constexpr double k_most_work = 4e8;
  static constexpr std::uint32_t k_widest_column = 4;
  static constexpr std::size_t k_many = 8000;

  static double box_area(const PackShape& shape) { return shape.size.x * shape.size.y; }
  static double longest(const PackShape& shape) { return std::max(shape.size.x, shape.size.y); }
  double side() const { return options_.side; }
  double share_of(double scale) const { return scale * scale * options_.area / (side() * side()); }

  /// The scale at which the boxes with their margins cover this share of the picture.
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
    double scale = scale_at_share(margin, k_usual_fill);
    std::optional<Packing> best;
    for (double step = 1.06; !best; step *= step) {
      best = pack_at(scale, margin);
      if (best) break;
      fails = scale;
      scale /= step;
      if (step > 1e6 || (margin > 1 && share_of(scale) < k_least_share)) return {};
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

  bool is_hasty() const { return shapes_.size() > k_many; }

  std::uint32_t column_for(double scale, std::uint32_t margin) const {
    double lengths = 0;
    for (const PackShape& shape : shapes_) {
      lengths += (shape.size.x + shape.size.y) * scale + 4 * margin;
    }
    std::uint32_t column = 1;
    const auto is_fine = [&](double width) {
      if (is_hasty()) return lengths / (2 * static_cast<double>(shapes_.size())) > 16 * width;
      return lengths * 2 * side() > k_most_work * width * width;
    };
    while (column < k_widest_column && is_fine(column)) column *= 2;
    return column;
  }

  std::optional<Packing> pack_at(double scale, std::uint32_t margin) const {
    const Raster raster{scale, margin, column_for(scale, margin)};
    if (raster.column > options_.side) return {};
    Gaps gaps(static_cast<int>(2 * margin + 1));
    Horizon horizon(options_.side, raster.column, is_hasty());
    Packing made{scale, margin, std::vector<PackPlace>(shapes_.size())};
    ShapeProfiles profiles;
    for (const std::uint32_t i : order_) {
      if (!profiles.measure(shapes_[i], raster, options_.side)) return {};
      const auto place = in_gap(profiles, gaps);
      made.places[i] = place ? *place : on_horizon(profiles, raster.column, horizon, gaps);
      if (made.places[i].width == 0) return {};
    }
    return made;
  }

  static PackPlace placed_at(const ShapeProfiles& shape, int turn, int x, int y) {
    return {static_cast<std::uint8_t>(turn), static_cast<std::uint16_t>(x),
            static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(shape.width()),
            static_cast<std::uint16_t>(shape.height())};
  }

  /// Fits the shape into a gap by its box.
  static std::optional<PackPlace> in_gap(const ShapeProfiles& shape, Gaps& gaps) {
    const Gaps::Size upright{shape.width(), shape.height()}, turned{shape.height(), shape.width()};
    const bool is_turned = gaps.waste(turned) < gaps.waste(upright);
    const auto gap = gaps.take(is_turned ? turned : upright);
    if (!gap) return {};
    return placed_at(shape, is_turned ? 1 : 0, gap->x, gap->y);
  }

  /// The width is 0 if the shape does not fit.
  static PackPlace on_horizon(const ShapeProfiles& shape, std::uint32_t column, Horizon& horizon,
                              Gaps& gaps) {
    Profile now, chosen;
    Horizon::Spot best;
    int best_turn = 0;
    for (int turn = 0; turn < 4; ++turn) {
      shape.turn(turn, now);
      const Horizon::Spot spot = horizon.best_spot(now);
      if (!(spot.score < best.score)) continue;
      best = spot;
      best_turn = turn;
      std::swap(chosen, now);
    }
    if (best.score == HUGE_VAL) return {};
    horizon.put(chosen, best, gaps);
    return placed_at(shape, best_turn, static_cast<int>(best.column * column), best.y);
  }

  /// For more shapes than texels: each shape lies in one texel, and texels hold several.
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
  std::vector<std::uint32_t> order_;  // the largest first
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
