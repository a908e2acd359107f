// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "geometry/generate/generate_grid.hpp"
#include "geometry/generate/generate_noise.hpp"
#include "geometry/generate/generate_shapes.hpp"

// A plate of unit squares with a hole each. A square is a stack of rings that run from its outline
// on the top over the hole's wall to its outline on the bottom:
//
//     square __        __ square     each ring has `side` points a side;
//              \______/              rings on a face are between the square and the circle,
//               |    |  wall         rings of the wall are circles.
//
// Outlines are shared by neighbours, and by the plate's own sides.

namespace meshfarm {
namespace {

constexpr std::uint64_t k_across = 3, k_along = 2;
constexpr std::uint64_t k_squares = k_across * k_along;
constexpr double k_thick = 0.5;
constexpr double k_ledge = 0.25;   // height of the counterbore's floor
constexpr double k_fillet = 0.06;  // where the hole meets the top
constexpr std::uint64_t k_min_side = 2;

/// The points of a ring lie at the share `square` of the way from a circle of this radius to the
/// outline.
struct Ring {
  double square = 0;
  double radius = 0;
  double z = 0;
};

struct Layers {
  std::uint64_t face, fillet, bore, ledge, drill;

  explicit Layers(std::uint64_t side)
      : face(of(side, 25)),
        fillet(of(side, 12) + 1),
        bore(of(side, 19)),
        ledge(of(side, 12)),
        drill(of(side, 25)) {}
  /// Per square: rings on its outlines do not count, because they are shared.
  std::uint64_t inner_rings() const { return face + fillet + bore + ledge + drill + face - 1; }

 private:
  static std::uint64_t of(std::uint64_t side, std::uint64_t percent) {
    return std::max<std::uint64_t>(1, (side * percent + 50) / 100);
  }
};

/// From the first ring inside the top's outline to the last before the bottom's.
std::vector<Ring> rings_of(const Layers& layers, double radius) {
  const double drill = 0.6 * radius, mouth = radius + k_fillet;
  std::vector<Ring> rings;
  const auto add = [&](std::uint64_t steps, const auto& ring) {
    for (std::uint64_t i = 1; i <= steps; ++i) {
      rings.push_back(ring(static_cast<double>(i) / static_cast<double>(steps)));
    }
  };
  add(layers.face, [&](double t) { return Ring{1 - t, mouth, k_thick}; });
  add(layers.fillet, [&](double t) {
    const Circle at = t < 1 ? on_circle(t / 4) : Circle{0, 1};
    return Ring{0, mouth - k_fillet * at.sin, k_thick - k_fillet + k_fillet * at.cos};
  });
  const double bore_top = k_thick - k_fillet;
  add(layers.bore, [&](double t) {
    return Ring{0, radius, t < 1 ? bore_top + (k_ledge - bore_top) * t : k_ledge};
  });
  add(layers.ledge, [&](double t) { return Ring{0, radius + (drill - radius) * t, k_ledge}; });
  add(layers.drill, [&](double t) { return Ring{0, drill, k_ledge * (1 - t)}; });
  add(layers.face, [&](double t) { return Ring{t, drill, 0}; });
  rings.pop_back();  // the bottom's outline
  return rings;
}

class Block : public GeneratedMesh {
 public:
  explicit Block(std::uint64_t triangles)
      : side_(side_for(triangles)), layers_(side_), walls_(walls_for(triangles)) {}
  std::uint64_t vertices() const override {
    return first_in_squares() + k_squares * layers_.inner_rings() * ring();
  }
  std::uint64_t triangles() const override {
    return triangles_of_squares(side_) + 2 * outline() * walls_;
  }
  void for_vertices(const TakeVertices& take) const override;
  void for_triangles(const TakeTriangles& take) const override;

 private:
  struct Point {
    std::uint64_t x = 0, y = 0;
  };

  static std::uint64_t triangles_of_squares(std::uint64_t side) {
    return k_squares * 2 * 4 * side * (Layers(side).inner_rings() + 1);
  }
  /// The largest number that still leaves the plate's sides triangles of about the same size.
  static std::uint64_t side_for(std::uint64_t triangles) {
    const auto fits = [&](std::uint64_t side) {
      const std::uint64_t walls = 4 * (k_across + k_along) * side * (side / 2 + 1);
      return triangles_of_squares(side) + walls <= triangles;
    };
    auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(triangles) / 100));
    while (side > k_min_side && !fits(side)) --side;
    side = std::max(side, k_min_side);
    while (fits(side + 1)) ++side;
    return side;
  }
  std::uint64_t walls_for(std::uint64_t triangles) const {
    const std::uint64_t rest = triangles - std::min(triangles, triangles_of_squares(side_));
    return std::max<std::uint64_t>(1, (rest + outline()) / (2 * outline()));
  }

  std::uint64_t ring() const { return 4 * side_; }
  std::uint64_t outline() const { return 2 * (k_across + k_along) * side_; }

  // Vertex order: on the lines between the squares of the top, of the bottom, on the sides between
  // top and bottom, inside the squares.
  std::uint64_t on_lines() const { return line_vertex({k_across * side_, k_along * side_}) + 1; }
  std::uint64_t first_in_squares() const { return 2 * on_lines() + (walls_ - 1) * outline(); }
  /// Every side-th row of points is a line; the other rows have a point on each crossing line.
  std::uint64_t line_vertex(Point p) const {
    const std::uint64_t line = k_across * side_ + 1, crossing = k_across + 1;
    // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): side_ is at least k_min_side
    const std::uint64_t band = p.y / side_, row = p.y % side_;
    const std::uint64_t before = band * (line + (side_ - 1) * crossing);
    return row == 0 ? before + p.x : before + line + (row - 1) * crossing + p.x / side_;
  }
  /// Counter-clockwise from the corner at the origin.
  static Point round(std::uint64_t i, Point size) {
    if (i < size.x) return {i, 0};
    if (i < size.x + size.y) return {size.x, i - size.x};
    if (i < 2 * size.x + size.y) return {2 * size.x + size.y - i, size.y};
    return {0, 2 * (size.x + size.y) - i};
  }
  Point on_square(std::uint64_t square, std::uint64_t i) const {
    const Point p = round(i, {side_, side_});
    return {p.x + square % k_across * side_, p.y + square / k_across * side_};
  }
  Point on_outline(std::uint64_t i) const { return round(i, {k_across * side_, k_along * side_}); }
  std::uint64_t wall_vertex(std::uint64_t layer, std::uint64_t i) const {
    if (layer == 0) return line_vertex(on_outline(i));
    if (layer == walls_) return on_lines() + line_vertex(on_outline(i));
    return 2 * on_lines() + (layer - 1) * outline() + i;
  }
  std::uint64_t ring_vertex(std::uint64_t square, std::uint64_t layer, std::uint64_t i) const {
    if (layer == 0) return line_vertex(on_square(square, i));
    if (layer > layers_.inner_rings()) return on_lines() + line_vertex(on_square(square, i));
    return first_in_squares() + (square * layers_.inner_rings() + layer - 1) * ring() + i;
  }

  Vec3 place(Point p, double z) const {
    return {static_cast<double>(p.x) / static_cast<double>(side_),
            static_cast<double>(p.y) / static_cast<double>(side_), z};
  }
  void add_lines(double z, Batches<Vec3>& batches) const;
  void add_square(std::uint64_t square, Batches<Vec3>& batches) const;

  std::uint64_t side_;
  Layers layers_;
  std::uint64_t walls_;  // layers of cells of the plate's sides
};

void Block::add_lines(double z, Batches<Vec3>& batches) const {
  for (std::uint64_t y = 0; y <= k_along * side_; ++y) {
    const std::uint64_t step = y % side_ == 0 ? 1 : side_;
    for (std::uint64_t x = 0; x <= k_across * side_; x += step) {
      batches.add(rounded(place({x, y}, z), PositionType::float32));
    }
  }
}

void Block::add_square(std::uint64_t square, Batches<Vec3>& batches) const {
  const std::uint64_t column = square % k_across, row = square / k_across;
  const Vec3 centre{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5, 0};
  const double radius = 0.22 + 0.03 * static_cast<double>(square);
  for (const Ring& layer : rings_of(layers_, radius)) {
    for (std::uint64_t i = 0; i < ring(); ++i) {
      const double turn = static_cast<double>(i) / static_cast<double>(ring()) + 0.625;
      const Circle at = on_circle(turn < 1 ? turn : turn - 1);
      const Vec3 round = centre + Vec3{at.cos, at.sin, 0} * layer.radius;
      Vec3 p = round + (place(on_square(square, i), 0) - round) * layer.square;
      p.z = layer.z;  // faces are exactly flat
      batches.add(rounded(p, PositionType::float32));
    }
  }
}

void Block::for_vertices(const TakeVertices& take) const {
  Batches<Vec3> batches(take);
  add_lines(k_thick, batches);
  add_lines(0, batches);
  for (std::uint64_t layer = 1; layer < walls_; ++layer) {
    const double share = static_cast<double>(layer) / static_cast<double>(walls_);
    for (std::uint64_t i = 0; i < outline(); ++i) {
      batches.add(rounded(place(on_outline(i), k_thick * (1 - share)), PositionType::float32));
    }
  }
  for (std::uint64_t square = 0; square < k_squares; ++square) add_square(square, batches);
  batches.finish();
}

void Block::for_triangles(const TakeTriangles& take) const {
  Batches<Corners> batches(take);
  for (std::uint64_t layer = 0; layer < walls_; ++layer) {
    for (std::uint64_t i = 0; i < outline(); ++i) {
      const std::uint64_t next = i + 1 < outline() ? i + 1 : 0;
      add_cell(batches, {wall_vertex(layer, i), wall_vertex(layer + 1, i),
                         wall_vertex(layer + 1, next), wall_vertex(layer, next)});
    }
  }
  for (std::uint64_t square = 0; square < k_squares; ++square) {
    for (std::uint64_t layer = 0; layer <= layers_.inner_rings(); ++layer) {
      for (std::uint64_t i = 0; i < ring(); ++i) {
        const std::uint64_t next = i + 1 < ring() ? i + 1 : 0;
        add_cell(batches,
                 {ring_vertex(square, layer, i), ring_vertex(square, layer, next),
                  ring_vertex(square, layer + 1, next), ring_vertex(square, layer + 1, i)});
      }
    }
  }
  batches.finish();
}

}  // namespace

std::unique_ptr<GeneratedMesh> make_block(std::uint64_t triangles) {
  return std::make_unique<Block>(triangles);
}

}  // namespace meshfarm
