// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <string>
#include <thread>

#include <dlfcn.h>
#include <doctest/doctest.h>

#include <meshfarm/util/checksum.hpp>

#include "divide/cell_graph.hpp"
#include "divide/cell_tree.hpp"

using namespace meshfarm;

namespace {

/// n x n cells of one vertex each, in a plane.
CellTree square_of_cells(int n) {
  Box box;
  box.add({0, 0, 0});
  box.add({1.0 * n, 1.0 * n, 0});
  CellTree tree(box, {.bits = 10});
  do {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) tree.add({x + 0.5, y + 0.5, 0});
    }
  } while (tree.refine());
  return tree;
}

}  // namespace

TEST_CASE("METIS cuts a square of cells into even, whole parts, the same each time") {
  const CellTree tree = square_of_cells(32);
  const std::span<const Cell> cells = tree.cells();
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

TEST_CASE("parts stay the same while other threads draw random numbers") {
  const CellTree tree = square_of_cells(32);
  const auto quiet = partition_cells(tree.cells(), {.parts = 8});
  // The rand() of the C library, from which ZeroMQ's threads may draw.
  auto* const draw = reinterpret_cast<int (*)()>(::dlsym(RTLD_NEXT, "rand"));
  REQUIRE(static_cast<bool>(draw));
  std::atomic<bool> ends = false;
  std::thread other([&] {
    while (!ends) draw();
  });
  int changed = 0;
  for (int i = 0; i < 10; ++i) changed += partition_cells(tree.cells(), {.parts = 8}) != quiet;
  ends = true;
  other.join();
  CHECK(changed == 0);
}

TEST_CASE("the version of METIS that parts depend on makes the parts that it always made") {
  CHECK(partitioner_name() == "METIS 5.1.0");
  const CellTree tree = square_of_cells(16);
  const auto text_of = [&](std::uint32_t parts) {
    std::string text;
    for (const std::uint32_t p : partition_cells(tree.cells(), {.parts = parts})) {
      text += static_cast<char>('a' + p);
    }
    return text;
  };
  const auto sum = [](const std::string& text) {
    Checksum all;
    all.add(text);
    return all.value();
  };
  CHECK(text_of(2) ==
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbbbbbbbb"
        "bbbbbbbbbaaaaaaa"
        "bbbbaaaaaaaaaaaa"
        "bbbaaaaaaaaaaaaa"
        "aaaaaaaaaaaaaaaa"
        "aaaaaaaaaaaaaaaa"
        "aaaaaaaaaaaaaaaa"
        "aaaaaaaaaaaaaaaa"
        "aaaaaaaaaaaaaaaa"
        "aaaaaaaaaaaaaaaa");
  CHECK(sum(text_of(12)) == 17307491491449845574U);
  CHECK(sum(text_of(40)) == 7456562086348892966U);
}

TEST_CASE("parts are numbered along a recursive bisection: a half of them is one region") {
  constexpr std::uint32_t k_side = 96;
  const CellTree tree = square_of_cells(k_side);
  for (const std::uint32_t parts : {8U, 16U, 29U, 40U}) {
    const auto part = partition_cells(tree.cells(), {.parts = parts});
    REQUIRE(*std::max_element(part.begin(), part.end()) == parts - 1);
    CAPTURE(parts);
    // The first half of all parts, then the first half of these, and so on.
    for (std::uint32_t range = parts; range >= 4; range /= 2) {
      CAPTURE(range);
      const auto is_first_half = [&](std::size_t cell) { return part[cell] < range / 2; };
      const auto is_inside = [&](std::size_t cell) { return part[cell] < range; };
      std::size_t inside = 0;
      std::size_t between = 0;
      for (std::size_t i = 0; i < part.size(); ++i) {
        if (!is_inside(i)) continue;
        ++inside;
        for (const std::size_t next : {i + 1, i + k_side}) {
          const bool is_neighbour = next < part.size() && (next != i + 1 || next % k_side != 0);
          if (!is_neighbour || !is_inside(next)) continue;
          between += is_first_half(i) != is_first_half(next) ? 1 : 0;
        }
      }
      // Two squares side by side share a line as long as the square root of half of their cells.
      CHECK(static_cast<double>(between) < 2 * std::sqrt(static_cast<double>(inside)));
    }
  }
}

TEST_CASE("more parts than cells, one part, no cells") {
  const CellTree tree = square_of_cells(2);
  const std::span<const Cell> cells = tree.cells();
  const auto part = partition_cells(cells, {.parts = 100});
  CHECK(std::set<std::uint32_t>(part.begin(), part.end()).size() <= 4);
  CHECK(*std::max_element(part.begin(), part.end()) < 4);
  CHECK(partition_cells(cells, {.parts = 1}) == std::vector<std::uint32_t>(4, 0));
  CHECK(partition_cells({}, {.parts = 3}).empty());
}

TEST_CASE("nearly as many parts as cells, and many of them, come out even") {
  struct Case {
    int side;
    std::uint32_t parts;
  };
  for (const Case& each : {Case{6, 33}, Case{7, 48}, Case{12, 40}, Case{96, 200}, Case{96, 500}}) {
    const int side = each.side;
    const std::uint32_t parts = each.parts;
    CAPTURE(side);
    CAPTURE(parts);
    const CellTree tree = square_of_cells(side);
    const auto part = partition_cells(tree.cells(), {.parts = parts});
    CHECK(part == partition_cells(tree.cells(), {.parts = parts, .threads = 3}));
    std::vector<std::uint32_t> sizes(parts, 0);
    for (const std::uint32_t p : part) ++sizes.at(p);
    const double even = 1.0 * side * side / parts;
    CHECK(*std::max_element(sizes.begin(), sizes.end()) <= std::ceil(1.1 * even));
  }
}

TEST_CASE("parts come out even where METIS leaves them uneven: cells of very different weights") {
  // Seven heavy cells and many light ones round them.
  std::vector<Cell> cells;
  for (int i = 0; i < 600; ++i) {
    const double turn = 0.1 * i;
    cells.push_back({.key = static_cast<std::uint64_t>(i),
                     .vertices = i % 86 == 0 ? 3000U : 1U + static_cast<unsigned>(i % 7) * 20U,
                     .mean = {turn * turn, 1.0 * (i % 3), 0},
                     .box = {}});
  }
  std::uint64_t all = 0;
  for (const Cell& cell : cells) all += cell.vertices;
  for (const std::uint32_t parts : {3U, 4U, 9U}) {
    const auto part = partition_cells(cells, {.parts = parts});
    std::vector<std::uint64_t> weights(parts, 0);
    for (std::size_t i = 0; i < cells.size(); ++i) weights[part[i]] += cells[i].vertices;
    const std::uint64_t most = *std::max_element(weights.begin(), weights.end());
    CHECK(most * parts <= all + 3000 * std::uint64_t{parts});
  }
}
