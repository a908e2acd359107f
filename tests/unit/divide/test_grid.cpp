// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "divide/grid.hpp"

using namespace meshfarm;

namespace {

Box grid_box(Vec3 lo, Vec3 hi) {
  Box box;
  box.add(lo);
  box.add(hi);
  return box;
}

}  // namespace

TEST_CASE("cells are cubes along the longest side, and the far corner is in the last") {
  const UniformGrid grid(grid_box({0, 0, 0}, {8, 4, 0}), 3);
  CHECK(grid.cell_of({0, 0, 0}) == 0);
  CHECK(grid.cell_of({0.99, 0.99, 0}) == 0);
  CHECK(grid.cell_of({1, 0, 0}) == 1);
  CHECK(grid.cell_of({0, 1, 0}) == 8);
  CHECK(grid.cell_of({8, 4, 0}) == 7 + 4 * 8);
  CHECK(grid.cell_of({9, 9, 9}) == 7 + 7 * 8 + 7 * 64);
  CHECK(grid.cell_of({-1, -1, -1}) == 0);
}

TEST_CASE("a box of no size has one cell") {
  const UniformGrid grid(grid_box({5, 5, 5}, {5, 5, 5}), 10);
  CHECK(grid.cell_of({5, 5, 5}) == 0);
  CHECK(UniformGrid(Box{}, 4).cell_of({1, 2, 3}) == 0);
}

TEST_CASE("zero and minus zero share a cell") {
  const UniformGrid grid(grid_box({-1, -1, -1}, {1, 1, 1}), 7);
  CHECK(grid.cell_of({0.0, 0.5, -0.0}) == grid.cell_of({-0.0, 0.5, 0.0}));
}

TEST_CASE("a coarsened grid has the cells of one made with fewer bits") {
  const Box box = grid_box({-3, 1, 2}, {4, 6, 4});
  UniformGrid grid(box, 6);
  const UniformGrid fine = grid;
  grid.coarsen();
  const UniformGrid coarse(box, 5);
  for (int i = 0; i <= 100; ++i) {
    const Vec3 p{-3 + 0.07 * i, 1 + 0.05 * i, 4 - 0.02 * i};
    CHECK(grid.cell_of(p) == coarse.cell_of(p));
    CHECK(grid.coarser_cell(fine.cell_of(p)) == coarse.cell_of(p));
  }
}
