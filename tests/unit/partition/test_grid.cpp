// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include <meshfarm/partition/cell_graph.hpp>
#include <meshfarm/partition/grid.hpp>

using namespace meshfarm;

namespace {

Box box_of(Vec3 lo, Vec3 hi) {
  Box box;
  box.add(lo);
  box.add(hi);
  return box;
}

/// n x n cells of one vertex each, in a plane.
std::vector<Cell> square_of_cells(int n) {
  CellTable table;
  const UniformGrid grid(box_of({0, 0, 0}, {1.0 * n, 1.0 * n, 0}), 10);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const Vec3 p{x + 0.5, y + 0.5, 0};
      table.add(grid.cell_of(p), p);
    }
  }
  table.finish();
  return table.cells();
}

}  // namespace

TEST_CASE("cells are cubes along the longest side, and the far corner is in the last") {
  const UniformGrid grid(box_of({0, 0, 0}, {8, 4, 0}), 3);
  CHECK(grid.cell_of({0, 0, 0}) == 0);
  CHECK(grid.cell_of({0.99, 0.99, 0}) == 0);
  CHECK(grid.cell_of({1, 0, 0}) == 1);
  CHECK(grid.cell_of({0, 1, 0}) == 8);
  CHECK(grid.cell_of({8, 4, 0}) == 7 + 4 * 8);
  CHECK(grid.cell_of({9, 9, 9}) == 7 + 7 * 8 + 7 * 64);
  CHECK(grid.cell_of({-1, -1, -1}) == 0);
}

TEST_CASE("a box of no size has one cell") {
  const UniformGrid grid(box_of({5, 5, 5}, {5, 5, 5}), 10);
  CHECK(grid.cell_of({5, 5, 5}) == 0);
  CHECK(UniformGrid(Box{}, 4).cell_of({1, 2, 3}) == 0);
}

TEST_CASE("zero and minus zero share a cell") {
  const UniformGrid grid(box_of({-1, -1, -1}, {1, 1, 1}), 7);
  CHECK(grid.cell_of({0.0, 0.5, -0.0}) == grid.cell_of({-0.0, 0.5, 0.0}));
}

TEST_CASE("the table counts vertices and their mean, and numbers cells by index") {
  CellTable table;
  for (std::uint64_t cell = 5000; cell > 0; --cell) {
    table.add(cell * 977, {1.0 * static_cast<double>(cell), 0, 0});
    table.add(cell * 977, {2.0 * static_cast<double>(cell), 1, 0});
  }
  table.finish();
  REQUIRE(table.cells().size() == 5000);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const Cell& cell = table.cells()[i];
    CHECK(cell.index == (i + 1) * 977);
    CHECK(cell.vertices == 2);
    CHECK(cell.mean == Vec3{1.5 * (i + 1), 0.5, 0});
    CHECK(table.number_of(cell.index) == i);
  }
}

TEST_CASE("METIS cuts a square of cells into even, whole parts, the same each time") {
  const std::vector<Cell> cells = square_of_cells(32);
  for (const std::uint32_t parts : {2U, 5U, 16U}) {
    CAPTURE(parts);
    const auto part = partition_cells(cells, {.parts = parts});
    CHECK(part == partition_cells(cells, {.parts = parts}));
    CHECK(part == partition_cells(cells, {.parts = parts, .threads = 1}));
    CHECK(part == partition_cells(cells, {.parts = parts, .threads = 3}));
    std::vector<std::size_t> sizes(parts, 0);
    for (const std::uint32_t p : part) {
      REQUIRE(p < parts);
      ++sizes[p];
    }
    const double even = 1024.0 / parts;
    for (const std::size_t size : sizes) {
      CHECK(static_cast<double>(size) > 0.8 * even);
      CHECK(static_cast<double>(size) < 1.2 * even);
    }
  }
}

TEST_CASE("more parts than cells, one part, no cells") {
  const std::vector<Cell> cells = square_of_cells(2);
  const auto part = partition_cells(cells, {.parts = 100});
  CHECK(std::set<std::uint32_t>(part.begin(), part.end()).size() <= 4);
  CHECK(*std::max_element(part.begin(), part.end()) < 4);
  CHECK(partition_cells(cells, {.parts = 1}) == std::vector<std::uint32_t>(4, 0));
  CHECK(partition_cells({}, {.parts = 3}).empty());
}
