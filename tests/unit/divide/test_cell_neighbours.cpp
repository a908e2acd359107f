// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "divide/cell_neighbours.hpp"
#include "divide/cell_tree.hpp"

using namespace meshfarm;

namespace {

/// The cells of points in a cube of 2^bits cells per side.
CellTree tree_of(unsigned bits, const std::vector<Vec3>& points) {
  const double side = 1U << bits;
  Box box;
  box.add({0, 0, 0});
  box.add({side, side, side});
  CellTree tree(box, {.bits = bits});
  do {
    for (const Vec3& p : points) tree.add(p);
  } while (tree.refine());
  return tree;
}

std::set<std::uint32_t> of_cell(const std::vector<std::uint32_t>& all, std::size_t k,
                                std::size_t cell) {
  std::set<std::uint32_t> some;
  for (std::size_t n = 0; n < k; ++n) {
    if (all[cell * k + n] != k_no_cell) some.insert(all[cell * k + n]);
  }
  return some;
}

std::size_t cell_at(const CellTree& tree, Vec3 p) {
  const auto cells = tree.cells();
  const auto at =
      std::find_if(cells.begin(), cells.end(), [&](const Cell& c) { return c.mean == p; });
  REQUIRE(at != cells.end());
  return static_cast<std::size_t>(at - cells.begin());
}

}  // namespace

TEST_CASE("the neighbours of a cell are the nearest of those beside it") {
  std::vector<Vec3> points;
  for (double z = 0.5; z < 4; ++z) {
    for (double y = 0.5; y < 4; ++y) {
      for (double x = 0.5; x < 4; ++x) points.push_back({x, y, z});
    }
  }
  const CellTree tree = tree_of(2, points);
  REQUIRE(tree.cells().size() == 64);
  constexpr std::size_t k_faces = 6;
  const auto all = cell_neighbours(tree.cells(), tree.grid_bits(), k_faces, 1);
  std::set<std::uint32_t> expected;
  for (const Vec3& beside : {Vec3{0.5, 1.5, 2.5},
                             {2.5, 1.5, 2.5},
                             {1.5, 0.5, 2.5},
                             {1.5, 2.5, 2.5},
                             {1.5, 1.5, 1.5},
                             {1.5, 1.5, 3.5}}) {
    expected.insert(static_cast<std::uint32_t>(cell_at(tree, beside)));
  }
  CHECK(of_cell(all, k_faces, cell_at(tree, {1.5, 1.5, 2.5})) == expected);
  // A corner cell has seven beside it, none of them on the other side of the grid.
  constexpr std::size_t k_corner = 7;
  const auto more = cell_neighbours(tree.cells(), tree.grid_bits(), k_corner, 1);
  for (const std::uint32_t other : of_cell(more, k_corner, cell_at(tree, {3.5, 0.5, 0.5}))) {
    const Vec3 way = tree.cells()[other].mean - Vec3{3.5, 0.5, 0.5};
    CHECK(squared_length(way) <= 3);
  }
}

TEST_CASE("a cell with few beside it has the nearest of all cells") {
  const CellTree tree =
      tree_of(4, {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {9.5, 9.5, 9.5}, {12.5, 9.5, 9.5}});
  const auto all = cell_neighbours(tree.cells(), tree.grid_bits(), 2, 1);
  const auto alone = static_cast<std::uint32_t>(cell_at(tree, {9.5, 9.5, 9.5}));
  const auto next = static_cast<std::uint32_t>(cell_at(tree, {12.5, 9.5, 9.5}));
  const auto second = static_cast<std::uint32_t>(cell_at(tree, {1.5, 0.5, 0.5}));
  CHECK(of_cell(all, 2, alone) == std::set<std::uint32_t>{next, second});
  // The same if the keys belonged to no grid.
  CHECK(cell_neighbours(tree.cells(), {}, 2, 1) == all);
  CHECK(of_cell(cell_neighbours(tree.cells(), {}, 9, 1), 9, alone).size() == 3);
}

TEST_CASE("the neighbours of cells do not depend on the threads") {
  std::vector<Vec3> points;
  for (int i = 0; i < 20'000; ++i) {
    const double x = i % 160, y = i / 160;
    points.push_back({x + 0.3, y + 0.6, 20.0 + i * 7919 % 13});
  }
  const CellTree tree = tree_of(8, points);
  const auto one = cell_neighbours(tree.cells(), tree.grid_bits(), 8, 1);
  CHECK(one == cell_neighbours(tree.cells(), tree.grid_bits(), 8, 3));
  CHECK(std::count(one.begin(), one.end(), k_no_cell) == 0);
  for (std::size_t i = 0; i < tree.cells().size(); ++i) {
    CHECK(of_cell(one, 8, i).size() == 8);
    CHECK(of_cell(one, 8, i).count(static_cast<std::uint32_t>(i)) == 0);
  }
}
