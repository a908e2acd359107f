// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Closed pieces that are thin.
#include <cmath>
#include <cstdint>
#include <functional>

#include <doctest/doctest.h>

#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// The cells of a plate along and across, and the thickness, of which `at` takes one side (0 or 1).
struct Plate {
  std::uint32_t along = 0;
  std::uint32_t across = 0;
  std::function<Vec3(std::uint32_t i, std::uint32_t j, int side)> at;
};

/// A closed plate: two sides, joined by a rim.
Mesh closed(const Plate& plate) {
  const std::uint32_t side = (plate.along + 1) * (plate.across + 1);
  Mesh mesh;
  for (const int s : {0, 1}) {
    for (std::uint32_t i = 0; i <= plate.along; ++i) {
      for (std::uint32_t j = 0; j <= plate.across; ++j) mesh.positions.push_back(plate.at(i, j, s));
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * (plate.across + 1) + j; };
  for (std::uint32_t i = 0; i < plate.along; ++i) {
    for (std::uint32_t j = 0; j < plate.across; ++j) {
      quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
      quad(side + at(i, j), side + at(i + 1, j), side + at(i + 1, j + 1), side + at(i, j + 1));
    }
  }
  const auto rim = [&](std::uint32_t a, std::uint32_t b) { quad(b, a, side + a, side + b); };
  for (std::uint32_t j = 0; j < plate.across; ++j) {
    rim(at(0, j), at(0, j + 1));
    rim(at(plate.along, j + 1), at(plate.along, j));
  }
  for (std::uint32_t i = 0; i < plate.along; ++i) {
    rim(at(i + 1, 0), at(i, 0));
    rim(at(i, plate.across), at(i + 1, plate.across));
  }
  return mesh;
}

/// A curved tile, thin beside its width.
Mesh roof_tile() {
  return closed({6, 10, [](std::uint32_t i, std::uint32_t j, int side) {
                   const double radius = side == 0 ? 1.0 : 0.9;
                   const double angle = 0.2 * j;
                   return Vec3{radius * std::cos(angle), radius * std::sin(angle), 0.4 * i};
                 }});
}

/// A sheet with this many ridges and valleys, whose edges are straight along it.
Mesh corrugated_sheet(std::uint32_t ridges) {
  constexpr std::uint32_t k_of_ridge = 16;  // flat, up, flat, down
  const auto height = [](std::uint32_t j) {
    const std::uint32_t phase = j % k_of_ridge;
    if (phase <= 4) return 0.0;
    if (phase <= 8) return 0.25 * (phase - 4);
    return phase <= 12 ? 1.0 : 0.25 * (16 - phase);
  };
  return closed({20, ridges * k_of_ridge, [=](std::uint32_t i, std::uint32_t j, int side) {
                   return Vec3{4.0 * i, 0.25 * j, height(j) - 0.05 * side};
                 }});
}

}  // namespace

TEST_CASE("topology: thin closed pieces are opened where that is fair, and do not fall to crumbs") {
  const Mesh tile = roof_tile();
  REQUIRE(check(tile).euler == 2);
  REQUIRE(check(tile).border_edges == 0);
  constexpr std::uint32_t k_tiles = 49;
  Mesh roof;
  for (std::uint32_t i = 0; i < k_tiles; ++i) append(roof, tile, {2.5 * (i % 7), 0, 3.0 * (i / 7)});
  const std::uint64_t goal = 7 * k_tiles;
  const Simplifier kept = reduced_topology(roof, goal, TopologyMode::keep);
  CHECK(check(kept.mesh()).border_edges == 0);
  const Simplifier result = reduced_topology(roof, goal);
  CHECK(result.triangles() <= goal);
  CHECK(result.simplifies_topology());
  CHECK(check(result.mesh()).components < 3 * k_tiles);
  CHECK(check(result.mesh()).border_edges > 3 * k_tiles);
  CHECK(topology_error(roof, result.mesh()).rms < 0.7 * topology_error(roof, kept.mesh()).rms);
  // With room enough, they stay closed.
  const Simplifier roomy = reduced_topology(roof, 3 * goal);
  CHECK(check(roomy.mesh()).border_edges == 0);
  CHECK(check(roomy.mesh()).components == k_tiles);
}

TEST_CASE("topology: what falls off a thin closed sheet is opened, and does not stay as crumbs") {
  const Mesh sheet = corrugated_sheet(28);
  REQUIRE(check(sheet).euler == 2);
  REQUIRE(check(sheet).border_edges == 0);
  Mesh sheets;
  for (int i = 0; i < 3; ++i) append(sheets, sheet, {0, 0, 3.0 * i});
  // As single sheets they need about 700 triangles, as closed ones four times as many.
  for (const std::uint64_t goal : {1000, 850, 700}) {
    CAPTURE(goal);
    const Simplifier result = reduced_topology(sheets, goal);
    CHECK(result.triangles() <= goal);
    CHECK(check(result.mesh()).border_edges > 500);
    CHECK(topology_error(sheets, result.mesh()).rms < 0.03);
  }
  // With far too few, what was opened costs more than what was closed, but is far nearer.
  const Simplifier few = reduced_topology(sheets, 300);
  CHECK(few.simplifies_topology());
  CHECK(topology_error(sheets, few.mesh()).rms < 0.6);
}
