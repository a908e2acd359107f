// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "geometry/simplify/thin_walls.hpp"
#include "geometry/simplify/vertex_flags.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

std::size_t thin_vertices(const Mesh& mesh, double reach) {
  std::vector<std::uint8_t> flags(mesh.positions.size(), 0);
  flag_thin_walls(mesh, reach, flags);
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), k_thin));
}

/// A sheet, and `apart` above it another that faces the other way or the same way.
Mesh two_sheets(double apart, bool is_turned) {
  Mesh mesh = test::grid(20, 20);
  const Mesh first = mesh;
  const auto count = static_cast<std::uint32_t>(first.positions.size());
  for (const Vec3& p : first.positions) mesh.positions.push_back(p + Vec3{0, 0, apart});
  for (Triangle t : first.triangles) {
    if (is_turned) std::swap(t[1], t[2]);
    mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return mesh;
}

}  // namespace

TEST_CASE("thin walls: sheets that face each other within reach") {
  const Mesh wall = two_sheets(2, true);
  CHECK(thin_vertices(wall, 2) == wall.positions.size());
  CHECK(thin_vertices(wall, 0.9) == 0);
  CHECK(thin_vertices(two_sheets(2, false), 2) == 0);
  CHECK(thin_vertices(test::icosphere(4), 0.1) == 0);
}

TEST_CASE("thin walls: triangles that face against each other in cells beside each other") {
  std::mt19937 random(5);
  for (const int cells : {9, 40}) {
    // The first corners span the box, so that cells begin at 0; each is as large as the reach.
    const auto last = static_cast<double>(cells);
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {last, last, last}};
    struct Place {
      std::array<int, 3> cell;
      bool is_up;
    };
    std::vector<Place> places;
    for (std::uint32_t i = 0; i < 120; ++i) {
      Place place{{}, random() % 2 == 0};
      for (int& at : place.cell) at = static_cast<int>(random() % static_cast<unsigned>(cells));
      const Vec3 p{place.cell[0] + 0.4, place.cell[1] + 0.4, place.cell[2] + 0.4};
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.insert(mesh.positions.end(), {p, p + Vec3{0.1, 0, 0}, p + Vec3{0, 0.1, 0}});
      Triangle t{first, first + 1, first + 2};
      if (!place.is_up) std::swap(t[1], t[2]);
      mesh.triangles.push_back(t);
      places.push_back(place);
    }
    std::vector<std::uint8_t> flags(mesh.positions.size(), 0);
    flag_thin_walls(mesh, 1, flags);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool is_opposed = std::any_of(places.begin(), places.end(), [&](const Place& other) {
        bool is_beside = other.is_up != places[i].is_up;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          is_beside = is_beside && std::abs(other.cell[axis] - places[i].cell[axis]) <= 1;
        }
        return is_beside;
      });
      CHECK((flags[mesh.triangles[i][0]] == k_thin) == is_opposed);
    }
  }
}

TEST_CASE("thin walls: what is no surface has none") {
  CHECK(thin_vertices({}, 1) == 0);
  CHECK(thin_vertices(two_sheets(1, true), 0) == 0);
  Mesh broken = two_sheets(1, true);
  broken.positions[0].x = std::numeric_limits<double>::infinity();
  broken.positions[1].y = std::numeric_limits<double>::quiet_NaN();
  CHECK(thin_vertices(broken, 1) > 0);
}
