// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "divide/cell_tree.hpp"

using namespace meshfarm;

namespace {

Box box_of(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

struct Counted {
  CellTree tree;
  int scans = 0;
};

Counted count(const std::vector<Vec3>& points, const CellTreeOptions& options) {
  Counted made{CellTree(box_of(points), options)};
  do {
    for (const Vec3& p : points) made.tree.add(p);
    ++made.scans;
  } while (made.tree.refine());
  return made;
}

/// n x n points of a unit square.
std::vector<Vec3> sheet(int n) {
  std::vector<Vec3> points;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) points.push_back({1.0 * x / n, 1.0 * y / n, 0});
  }
  return points;
}

std::uint64_t heaviest(const CellTree& tree) {
  std::uint64_t most = 0;
  for (const Cell& cell : tree.cells()) most = std::max(most, cell.vertices);
  return most;
}

/// Checks that number_of() gives each vertex's cell, and that the cells hold all vertices.
void check_numbers(CellTree& tree, const std::vector<Vec3>& points) {
  std::vector<std::uint64_t> counts(tree.cells().size(), 0);
  for (const Vec3& p : points) {
    const std::uint32_t number = tree.number_of(p);
    REQUIRE(number < counts.size());
    ++counts[number];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) CHECK(counts[i] == tree.cells()[i].vertices);
}

}  // namespace

TEST_CASE("where vertices are spread evenly one scan does, and cells are those of the grid") {
  const std::vector<Vec3> points = sheet(100);
  Counted made = count(points, {.bits = 5, .parts = 8});
  CHECK(made.scans == 1);
  CHECK(made.tree.cells().size() == 32 * 32);
  check_numbers(made.tree, points);
  const Cell& cell = made.tree.cells()[0];
  CHECK(cell.box.lo == Vec3{0, 0, 0});
  CHECK(cell.mean.x == doctest::Approx(0.5 * (cell.box.lo.x + cell.box.hi.x)));
}

TEST_CASE("vertices far out make no cell coarser") {
  const std::vector<Vec3> inner = sheet(100);
  for (const double far : {1e2, 1e4, 1e8, 1e300}) {
    CAPTURE(far);
    std::vector<Vec3> points = inner;
    points.push_back({far, far, far});
    points.push_back({-0.5 * far, 0, 0.1 * far});
    Counted made = count(points, {.bits = 5, .parts = 8});
    CHECK(made.scans <= 3);
    CHECK(heaviest(made.tree) <= points.size() / 8 / 32);
    check_numbers(made.tree, points);
  }
  std::vector<Vec3> points = inner;  // and some farther and farther out
  for (double far = 2; far < 1e30; far *= 3) points.push_back({far, -far, 0});
  Counted made = count(points, {.bits = 5, .parts = 8});
  CHECK(heaviest(made.tree) <= points.size() / 8 / 32);
  check_numbers(made.tree, points);
}

TEST_CASE("cells that are too heavy are divided where vertices lie closer together") {
  std::vector<Vec3> points = sheet(100);
  for (const Vec3& p : sheet(300)) points.push_back({0.5 + 0.001 * p.x, 0.5 + 0.001 * p.y, 0});
  Counted made = count(points, {.bits = 5, .parts = 8});
  CHECK(heaviest(made.tree) <= points.size() / 8 / 32);
  CHECK(made.tree.cells().size() < 20'000);
  check_numbers(made.tree, points);
}

TEST_CASE("the number of cells is bounded, in a cloud that fills its box, too") {
  std::vector<Vec3> points;
  std::mt19937 random(1);
  const auto any = [&] { return static_cast<double>(random() % 10'000); };
  for (int i = 0; i < 20'000; ++i) points.push_back({any(), any(), any()});
  for (const Vec3& p : sheet(50)) points.push_back(p);
  Counted made = count(points, {.bits = 10, .parts = 4, .most_cells = 1500});
  CHECK(made.tree.cells().size() <= 1500);
  CHECK(made.tree.cells().size() > 100);
  check_numbers(made.tree, points);
}

TEST_CASE("the cells do not depend on the order of the vertices") {
  std::vector<Vec3> points = sheet(60);
  for (const Vec3& p : sheet(200)) points.push_back({100 + p.x, p.y, p.x * p.y});
  const Counted first = count(points, {.bits = 9, .parts = 4, .most_cells = 2000});
  std::shuffle(points.begin(), points.end(), std::mt19937(7));
  const Counted second = count(points, {.bits = 9, .parts = 4, .most_cells = 2000});
  REQUIRE(first.tree.cells().size() == second.tree.cells().size());
  for (std::size_t i = 0; i < first.tree.cells().size(); ++i) {
    CHECK(first.tree.cells()[i].key == second.tree.cells()[i].key);
    CHECK(first.tree.cells()[i].vertices == second.tree.cells()[i].vertices);
  }
}

TEST_CASE("many vertices at one point weigh as one if they are welded, or else make many cells") {
  std::vector<Vec3> points = sheet(50);
  points.insert(points.begin() + 99, 5000, Vec3{0.25, 0.25, 0});
  points.insert(points.end(), 777, Vec3{0.5, 0.25, 0});
  const std::size_t heavy = points.size() / 8 / 32;
  const Counted welded = count(points, {.bits = 5, .parts = 8});
  CHECK(heaviest(welded.tree) <= heavy);
  const auto cells = welded.tree.cells();
  CHECK(std::count_if(cells.begin(), cells.end(), [](const Cell& c) { return c.is_one; }) == 2);
  Counted apart = count(points, {.bits = 5, .parts = 8, .weld = Weld::off});
  CHECK(heaviest(apart.tree) <= heavy);
  CHECK(apart.tree.cells().size() < 2 * cells.size() + 600);
  check_numbers(apart.tree, points);
  CHECK(count({}, {.bits = 5, .parts = 8}).tree.cells().empty());
  CHECK(count({{1, 1, 1}}, {.bits = 5, .parts = 8}).tree.cells().size() == 1);
}
