// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "divide/boundary_numbers.hpp"

using namespace meshfarm;

namespace {

using Numbers = std::vector<std::uint32_t>;

MeshShare share_at(const std::vector<double>& xs, const Numbers& boundary) {
  MeshShare share;
  for (const double x : xs) share.positions.push_back({x, 0, 0});
  share.boundary = boundary;
  return share;
}

}  // namespace

TEST_CASE("boundary vertices are numbered by place where nothing is sorted") {
  const BoundaryNumbers made = number_as_they_are(share_at({5, 4, 3, 2}, {3, 0, 3}));
  CHECK(made.places == Numbers{0, 3});
  CHECK(made.numbers == Numbers{0, 1});
  CHECK(made.points.empty());
  CHECK(made.count() == 2);
  CHECK(number_as_they_are(share_at({1, 2}, {})).count() == 0);
}

TEST_CASE("in a slab only boundary vertices count, in the order of the sweep") {
  const MeshShare share = share_at({5, 4, 3, 2, 1}, {4, 0, 2});
  CHECK(number_boundary(share, {}).numbers == Numbers{2, 1, 0});
  CHECK(number_boundary(share, {{{0, 1, 2}, -1}, Weld::exact}).numbers == Numbers{0, 1, 2});
}

TEST_CASE("boundary vertices at one point have one number, unless nothing is welded") {
  const MeshShare share = share_at({7, 3, 7, 3, 9}, {0, 1, 2, 3, 4});
  CHECK(number_boundary(share, {{}, Weld::exact}).numbers == Numbers{1, 0, 1, 0, 2});
  const BoundaryNumbers apart = number_boundary(share, {{}, Weld::off});
  CHECK(apart.numbers == Numbers{2, 0, 3, 1, 4});
  CHECK(apart.count() == 5);
}

TEST_CASE("sheets at one point have numbers of their own, and tell that they are at one point") {
  MeshShare share = share_at({7, 7, 7, 7, 1}, {0, 1, 2, 3, 4});
  share.apart = {{0, 1}, {1, 0}, {2, 1}, {3, 0}};
  const BoundaryNumbers made = number_boundary(share, {});
  CHECK(made.numbers == Numbers{2, 1, 2, 1, 0});
  REQUIRE(made.points.size() == 5);
  for (const std::size_t i : {1, 2, 3}) CHECK(made.points[i] == made.points[0]);
  CHECK(made.points[4] != made.points[0]);
}

TEST_CASE("numbers are those of a plain sort, whatever the order of the vertices") {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> xs(1 + random() % 40);
    for (double& x : xs) x = static_cast<double>(random() % 12);
    Numbers boundary;
    for (std::uint32_t i = 0; i < xs.size(); ++i) {
      if (random() % 2 == 0) boundary.push_back(i);
    }
    std::shuffle(boundary.begin(), boundary.end(), random);
    std::map<double, std::uint32_t> order;
    for (const std::uint32_t b : boundary) order[xs[b]] = 0;
    std::uint32_t count = 0;
    for (auto& [x, number] : order) number = count++;

    const BoundaryNumbers made = number_boundary(share_at(xs, boundary), {});
    REQUIRE(made.places.size() == boundary.size());
    CHECK(made.count() == count);
    for (std::size_t i = 0; i < made.places.size(); ++i) {
      CHECK(made.numbers[i] == order[xs[made.places[i]]]);
    }
  }
}
