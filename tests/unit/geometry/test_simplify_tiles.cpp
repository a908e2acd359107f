// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Many small closed pieces that are thin.
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// A closed curved tile, thin beside its width.
Mesh roof_tile() {
  constexpr std::uint32_t k_along = 6;
  constexpr std::uint32_t k_across = 10;
  constexpr std::uint32_t k_side = (k_along + 1) * (k_across + 1);
  Mesh mesh;
  for (const double radius : {1.0, 0.9}) {
    for (std::uint32_t i = 0; i <= k_along; ++i) {
      for (std::uint32_t j = 0; j <= k_across; ++j) {
        const double angle = 0.2 * j;
        mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.4 * i});
      }
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const auto at = [](std::uint32_t i, std::uint32_t j) { return i * (k_across + 1) + j; };
  for (std::uint32_t i = 0; i < k_along; ++i) {
    for (std::uint32_t j = 0; j < k_across; ++j) {
      quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
      quad(k_side + at(i, j), k_side + at(i + 1, j), k_side + at(i + 1, j + 1),
           k_side + at(i, j + 1));
    }
  }
  const auto rim = [&](std::uint32_t a, std::uint32_t b) { quad(b, a, k_side + a, k_side + b); };
  for (std::uint32_t j = 0; j < k_across; ++j) {
    rim(at(0, j), at(0, j + 1));
    rim(at(k_along, j + 1), at(k_along, j));
  }
  for (std::uint32_t i = 0; i < k_along; ++i) {
    rim(at(i + 1, 0), at(i, 0));
    rim(at(i, k_across), at(i + 1, k_across));
  }
  return mesh;
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
