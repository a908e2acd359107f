// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "geometry/bvh_morton.hpp"
#include "test_simplify_meshes.hpp"

using namespace meshfarm;

namespace {

std::vector<Vec3> random_places(std::size_t count) {
  simplify_test::Random random(1);
  std::vector<Vec3> places(count);
  for (Vec3& p : places) p = {random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
  return places;
}

/// The order of all finite places, by the codes of the places times `scale`.
std::vector<std::uint32_t> order_of(const std::vector<Vec3>& places, double scale) {
  std::vector<MortonItem> items(places.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    items[i].number = i;
    if (is_finite(places[i])) items[i].code = morton_code(places[i] * scale);
  }
  sort_along_curve(items, [&](std::uint32_t i) { return places[i]; });
  return numbers_of(items);
}

/// The length of the way from each place to the next.
double way_along(const std::vector<Vec3>& places, const std::vector<std::uint32_t>& order) {
  double way = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    way += length(places[order[i]] - places[order[i - 1]]);
  }
  return way;
}

}  // namespace

TEST_CASE("a curve's order: codes first, equal ones as they came") {
  std::vector<Vec3> places = random_places(1000);
  for (std::size_t i = 0; i < places.size(); i += 2) places[i] = places[i / 20 * 20];
  const std::vector<std::uint32_t> order = order_of(places, 1);
  const auto code = [&](std::uint32_t i) { return morton_code(places[i]); };
  CHECK(std::is_sorted(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return code(a) != code(b) ? code(a) < code(b) : a < b;
  }));
}

TEST_CASE(
    "a curve's order: many places in one cell are as near one after the other as in a frame "
    "of their own") {
  const std::vector<Vec3> places = random_places(3000);
  const double own = way_along(places, order_of(places, 1));
  CHECK(own < 0.2 * way_along(places, order_of(std::vector<Vec3>(3000), 1)));
  for (const double scale : {1e-7, 1e-20, 1e-300, 0.0}) {
    CAPTURE(scale);
    CHECK(way_along(places, order_of(places, scale)) < 1.1 * own);
  }
}

TEST_CASE(
    "a curve's order: places that are all the same, or none, end the search for a finer one") {
  std::vector<Vec3> places(200, Vec3{0.1, 0.2, 0.3});
  std::vector<std::uint32_t> expected(places.size());
  for (std::uint32_t i = 0; i < expected.size(); ++i) expected[i] = i;
  CHECK(order_of(places, 1) == expected);
  for (Vec3& p : places) p.x = std::numeric_limits<double>::quiet_NaN();
  CHECK(order_of(places, 1) == expected);
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = {std::numeric_limits<double>::denorm_min() * static_cast<double>(i % 3), 0, 0};
  }
  CHECK(order_of(places, 1) == expected);  // 1 / their size is not finite
}
