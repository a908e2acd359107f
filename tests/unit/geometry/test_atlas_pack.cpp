// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/random_unit.hpp"
#include "geometry/texture/atlas_horizon.hpp"
#include "geometry/texture/atlas_pack.hpp"

using namespace meshfarm;

namespace {

using Outline = std::vector<std::array<Flat, 2>>;

Outline outline_of(const std::vector<Flat>& corners) {
  Outline made;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    made.push_back({corners[i], corners[(i + 1) % corners.size()]});
  }
  return made;
}

struct Shapes {
  std::vector<Outline> outlines;
  std::vector<PackShape> shapes;
  double area = 0;

  void add(const std::vector<Flat>& corners) {
    FlatBox box;
    for (const Flat& p : corners) box.add(p);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      area += cross(corners[i], corners[(i + 1) % corners.size()]) / 2;
    }
    outlines.push_back(outline_of(corners));
    shapes.push_back({box.hi, {}});
  }
  Packing pack(std::uint32_t side, std::uint32_t margin) {
    for (std::size_t i = 0; i < shapes.size(); ++i) shapes[i].outline = outlines[i];
    return pack_shapes(shapes, {.side = side, .margin = margin, .area = area});
  }
};

/// An L whose arms have the length `size` and the width 1.
std::vector<Flat> angle_of(double size) {
  return {{0, 0}, {size, 0}, {size, 1}, {1, 1}, {1, size}, {0, size}};
}

/// The distance between two outlines, the larger of both axes'; by points along them.
double apart(const Packing& packing, const Shapes& shapes, std::size_t a, std::size_t b) {
  const auto points = [&](std::size_t shape) {
    std::vector<Flat> made;
    for (const auto& [p, q] : shapes.outlines[shape]) {
      for (int i = 0; i < 20; ++i) {
        made.push_back(packing.placed(p + (q - p) * (i / 20.0), packing.places[shape]));
      }
    }
    return made;
  };
  double least = HUGE_VAL;
  const std::vector<Flat> of_b = points(b);
  for (const Flat& p : points(a)) {
    for (const Flat& q : of_b) {
      least = std::min(least, std::max(std::fabs(p.x - q.x), std::fabs(p.y - q.y)));
    }
  }
  return least;
}

void check_packed(const Packing& packing, const Shapes& shapes, double side) {
  for (std::size_t a = 0; a < shapes.shapes.size(); ++a) {
    for (const auto& sides : shapes.outlines[a]) {
      const Flat p = packing.placed(sides[0], packing.places[a]);
      CHECK(std::min({p.x, p.y, side - p.x, side - p.y}) >= packing.margin - 1e-9);
    }
    for (std::size_t b = 0; b < a; ++b) {
      CHECK(apart(packing, shapes, a, b) >= 2 * packing.margin - 1e-9);
    }
  }
}

}  // namespace

TEST_CASE("one square fills the picture but for its margin") {
  Shapes shapes;
  shapes.add({{0, 0}, {3, 0}, {3, 3}, {0, 3}});
  const Packing packing = shapes.pack(100, 4);
  CHECK(packing.margin == 4);
  CHECK(packing.scale * 3 == doctest::Approx(92).epsilon(0.01));
  check_packed(packing, shapes, 100);
}

TEST_CASE("angles are laid into each other") {
  Shapes shapes;
  for (int i = 0; i < 12; ++i) shapes.add(angle_of(10 - 0.5 * i));
  const Packing packing = shapes.pack(256, 2);
  check_packed(packing, shapes, 256);
  // Their boxes alone have more than the picture.
  double boxes = 0;
  for (const PackShape& shape : shapes.shapes) {
    boxes += shape.size.x * shape.size.y * packing.scale * packing.scale;
  }
  CHECK(boxes > 0.9 * 256 * 256);
}

TEST_CASE("many shapes of all sizes are packed, and small ones fill gaps") {
  Shapes shapes;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const double size = 10 / (1 + 0.2 * static_cast<double>(i));
    const double x = size * (0.2 + random_unit(2 * i)), y = size * (0.2 + random_unit(2 * i + 1));
    if (i % 3 == 0) {
      shapes.add({{0, 0}, {x, 0}, {0, y}});
    } else {
      shapes.add({{x / 2, 0}, {x, y / 2}, {x / 2, y}, {0, y / 2}});
    }
  }
  const Packing packing = shapes.pack(400, 3);
  CHECK(packing.margin == 3);
  check_packed(packing, shapes, 400);
  CHECK(shapes.area * packing.scale * packing.scale > 0.3 * 400 * 400);
}

TEST_CASE("a long shape is turned, a flat line has a place") {
  Shapes shapes;
  shapes.add({{0, 0}, {100, 0}, {100, 1}, {0, 1}});
  shapes.add({{0, 0}, {1, 0}, {1, 100}, {0, 100}});
  shapes.add({{0, 0}, {50, 0}, {50, 0}});
  check_packed(shapes.pack(64, 4), shapes, 64);
}

TEST_CASE("a gap is divided by what is put into it") {
  Gaps gaps(3);
  gaps.add({10, 20, 8, 2});  // too low to be kept
  CHECK(gaps.size() == 0);
  gaps.add({10, 20, 8, 6});
  CHECK(gaps.waste({9, 3}) == HUGE_VAL);
  CHECK(gaps.waste({5, 6}) == 0);
  const auto first = gaps.take({4, 3});
  REQUIRE(first);
  CHECK(first->x == 10);
  CHECK(first->y == 20);
  const auto second = gaps.take({4, 6});
  REQUIRE(second);
  CHECK(second->x == 14);
  const auto third = gaps.take({3, 3});
  REQUIRE(third);
  CHECK(third->y == 23);
  CHECK_FALSE(gaps.take({3, 3}));
}

TEST_CASE("what lies over a hollow leaves a gap") {
  Horizon horizon(20, 1, false);
  Gaps gaps(2);
  const Profile bridge{{4, 4, 0, 0}, {6, 6, 6, 6}, 8, 6};
  const Horizon::Spot spot = horizon.best_spot(bridge);
  CHECK(spot.y == 0);
  horizon.put(bridge, spot, gaps);
  CHECK(gaps.waste({2, 4}) == 0);
  CHECK(gaps.waste({3, 4}) == HUGE_VAL);
}
