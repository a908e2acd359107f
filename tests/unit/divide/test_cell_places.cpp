// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

#include "divide/cell_map.hpp"
#include "divide/cell_places.hpp"

using namespace meshfarm;

namespace {

/// Points dense in one corner, hollow in the middle, with one far outlier and 3,000 vertices at
/// one point.
std::vector<Vec3> uneven_points() {
  std::mt19937_64 random(7);
  std::vector<Vec3> points;
  const auto along = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 40'000; ++i) {
    const double size = i % 2 == 0 ? 1 : 1e-3;
    const double x = along();
    points.push_back({size * (x < 0.5 ? 0.8 * x : 0.2 + 0.8 * x), size * along(), size * along()});
  }
  points.push_back({1e4, -20, 3});
  points.insert(points.begin() + 17, 3000, Vec3{0.25, 0.25, 0});
  return points;
}

CellMap divided_map(const std::vector<Vec3>& points, std::uint32_t parts) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  CellMap map(box, {parts, Weld::exact, 1});
  do {
    map.count(points);
  } while (map.refine());
  map.divide();
  return map;
}

}  // namespace

TEST_CASE("points that fill space have no more cells than a surface may have") {
  std::vector<Vec3> points;
  constexpr int k_side = 40;
  for (int i = 0; i < k_side * k_side * k_side; ++i) {
    points.push_back(
        {1.0 * (i % k_side), 1.0 * (i / k_side % k_side), 1.0 * (i / k_side / k_side)});
  }
  const std::string bytes = divided_map(points, 2).encode(CellTree::Which::places);
  ByteReader in(bytes, "cells");
  CHECK(in.get<std::uint32_t>() == 2);
  const std::size_t cells = CellTree::get_places(in).keys.size();
  // 32 x 32 x 32 cells would be 32 times as many as a side has.
  CHECK(cells == 16 * 16 * 16);
}

TEST_CASE("a table of keys finds each key of several grids, and no other") {
  std::mt19937_64 random(3);
  std::vector<std::uint64_t> keys{0, 1, 7, 4'000'000'000};
  const auto key = [](std::uint64_t grid, std::uint64_t index) {
    return grid << CellTree::k_index_bits | index;
  };
  keys.push_back(key(2, 0));
  for (int i = 0; i < 500; ++i) keys.push_back(key(3, random() % 700));
  for (int i = 0; i < 500; ++i) keys.push_back(key(5, random() % 68'719'476'736));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const KeyTable table(keys, 6);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CHECK(table.find(keys[i]) == i);
    for (const std::uint64_t other : {keys[i] - 1, keys[i] + 1}) {
      const bool is_there = std::binary_search(keys.begin(), keys.end(), other);
      CHECK((table.find(other) != KeyTable::k_none) == is_there);
    }
  }
  CHECK(table.find(key(1, 0)) == KeyTable::k_none);
  CHECK(table.find(key(6, 0)) == KeyTable::k_none);
  CHECK(KeyTable({}, 1).find(0) == KeyTable::k_none);
}

TEST_CASE("places in a file tell of each vertex what the cells do that were divided") {
  const std::vector<Vec3> points = uneven_points();
  for (const std::uint32_t parts : {2U, 40U}) {
    CAPTURE(parts);
    CellMap map = divided_map(points, parts);
    CHECK(map.merges());
    const std::string bytes = map.encode(CellTree::Which::places);
    const CellPlaces places = CellPlaces::decode(bytes);
    ShareTargets expected, found;
    map.find_targets(points, expected);
    places.find_targets(points, found);
    CHECK(found.shares == expected.shares);
    CHECK(found.points == expected.points);
  }
}

TEST_CASE("a vertex that was not counted is an error") {
  const CellMap map = divided_map(uneven_points(), 40);
  const CellPlaces places = CellPlaces::decode(map.encode(CellTree::Which::places));
  const auto find = [&](Vec3 p) {
    ShareTargets targets;
    places.find_targets(std::vector<Vec3>{p}, targets);
  };
  CHECK_NOTHROW(find({1e4, -20, 3}));
  CHECK_THROWS_AS(find({5e3, 2, 3}), DataError);
  // In a divided cell, where the finer grid has no cell.
  CHECK_THROWS_AS(find({0.5, 0.5, 0.5}), DataError);
}

TEST_CASE("bytes of places that are cut off are an error, and changed ones never a crash") {
  const std::vector<Vec3> points = uneven_points();
  const std::string bytes = divided_map(points, 4).encode(CellTree::Which::places);
  std::mt19937_64 random(9);
  for (int i = 0; i < 200; ++i) {
    CHECK_THROWS_AS(CellPlaces::decode(bytes.substr(0, random() % bytes.size())), DataError);
    std::string changed = bytes;
    // Half of the changes are to what stands before the cells.
    changed[random() % (i % 2 == 0 ? 200 : bytes.size())] ^= static_cast<char>(1 << random() % 8);
    try {
      ShareTargets targets;
      CellPlaces::decode(changed).find_targets(points, targets);
    } catch (const DataError&) {
    }
  }
  CHECK_THROWS_AS(CellMap::decode(bytes), DataError);
}

TEST_CASE("places that contradict each other are an error") {
  CellMap map = divided_map(uneven_points(), 40);
  const std::string bytes = map.encode(CellTree::Which::places);
  ByteReader in(std::string_view(bytes).substr(sizeof(std::uint32_t)), "cells");
  const CellTree::Places places = CellTree::get_places(in);
  REQUIRE(places.divided_by.size() > 1);
  constexpr std::size_t k_record = 13, k_grid = 8, k_number = 4;
  const std::size_t parts = bytes.size() - k_number * places.is_one.size();
  const std::size_t last = parts - k_number - k_record;  // a divided cell
  const auto with = [&](std::size_t at, std::uint32_t value) {
    std::string changed = bytes;
    std::memcpy(changed.data() + at, &value, sizeof value);
    return changed;
  };
  const auto own = static_cast<std::uint32_t>(places.keys.back() >> CellTree::k_index_bits);
  CHECK_NOTHROW(CellPlaces::decode(with(last + k_grid, places.divided_by.back())));
  CHECK_THROWS_AS(CellPlaces::decode(with(last + k_grid, own)), DataError);
  CHECK_THROWS_AS(
      CellPlaces::decode(with(last + k_grid, static_cast<std::uint32_t>(places.grids.size()))),
      DataError);
  CHECK_THROWS_AS(CellPlaces::decode(with(parts, 40)), DataError);
  std::string swapped = bytes;
  std::swap_ranges(swapped.begin() + static_cast<std::ptrdiff_t>(last),
                   swapped.begin() + static_cast<std::ptrdiff_t>(last + k_record),
                   swapped.begin() + static_cast<std::ptrdiff_t>(last - k_record));
  CHECK_THROWS_AS(CellPlaces::decode(swapped), DataError);
}
