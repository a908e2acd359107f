// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What becomes of handles, pieces, turned triangles and lines where sheets meet.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

double diagonal(const Mesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  return box.diagonal();
}

Mesh scaled(Mesh mesh, double factor) {
  for (Vec3& p : mesh.positions) p = p * factor;
  return mesh;
}

using Cell = std::array<std::uint32_t, 3>;

/// The surface of unit cubes, which may touch at edges and at corners. No cell is 0.
template <typename IsSolid>
Mesh surface_of_cells(const Cell& last, const IsSolid& is_solid) {
  Mesh mesh;
  std::map<Cell, std::uint32_t> numbers;
  const auto number = [&](const Cell& at) {
    const auto [found, is_new] =
        numbers.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back({1.0 * at[0], 1.0 * at[1], 1.0 * at[2]});
    return found->second;
  };
  const auto add_face = [&](const Cell& cell, std::size_t axis, bool is_upper) {
    const auto at = [&](std::uint32_t i, std::uint32_t k) {
      Cell corner = cell;
      corner[axis] += is_upper ? 1 : 0;
      corner[(axis + 1) % 3] += is_upper ? i : k;
      corner[(axis + 2) % 3] += is_upper ? k : i;
      return number(corner);
    };
    mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
    mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
  };
  Cell cell{};
  for (cell[0] = 1; cell[0] <= last[0]; ++cell[0]) {
    for (cell[1] = 1; cell[1] <= last[1]; ++cell[1]) {
      for (cell[2] = 1; cell[2] <= last[2]; ++cell[2]) {
        if (!is_solid(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          Cell above = cell;
          Cell below = cell;
          ++above[axis];
          --below[axis];
          if (!is_solid(above)) add_face(cell, axis, true);
          if (!is_solid(below)) add_face(cell, axis, false);
        }
      }
    }
  }
  return mesh;
}

/// A bent plate with holes x holes square holes: closed, one handle per hole.
///
///     +---------+
///     | +-+ +-+ |
///     | +-+ +-+ |
///     +---------+
Mesh perforated_plate(std::uint32_t holes) {
  constexpr std::uint32_t k_fine = 3;  // cells across a hole
  const std::uint32_t size = (2 * holes + 1) * k_fine;
  // Cells count from 1, so that each has a cell beside it.
  const auto is_solid = [&](const Cell& c) {
    if (std::min({c[0], c[1], c[2]}) == 0 || std::max(c[0], c[1]) > size || c[2] > 2) return false;
    return (c[0] - 1) / k_fine % 2 == 0 || (c[1] - 1) / k_fine % 2 == 0;
  };
  Mesh mesh = surface_of_cells({size, size, 2}, is_solid);
  for (Vec3& p : mesh.positions) {
    const double x = p.x / size;
    const double y = p.y / size;
    p = {x, y, p.z / size + 0.1 * std::sin(5 * x) * std::cos(4 * y)};
  }
  return mesh;
}

Mesh plate() {
  return perforated_plate(6);
}

/// Two spheres joined by a tube of four sides: a dumbbell.
Mesh dumbbell() {
  Mesh mesh = sphere(4);
  append(mesh, sphere(4), {4, 0, 0});
  // The triangles round the two vertices that face each other make way for the tube.
  const std::uint32_t half = static_cast<std::uint32_t>(mesh.positions.size() / 2);
  const std::uint32_t left = 0;
  const std::uint32_t right = half + 1;
  const auto ring_of = [&](std::uint32_t centre) {
    std::vector<std::uint32_t> ring;
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) {
        if (std::find(t.begin(), t.end(), centre) != t.end() && v != centre) ring.push_back(v);
      }
    }
    std::sort(ring.begin(), ring.end(), [&](std::uint32_t v, std::uint32_t w) {
      const Vec3 p = mesh.positions[v];
      const Vec3 q = mesh.positions[w];
      return std::atan2(p.z, p.y) < std::atan2(q.z, q.y);
    });
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    return ring;
  };
  const std::vector<std::uint32_t> from = ring_of(left);
  const std::vector<std::uint32_t> to = ring_of(right);
  REQUIRE(from.size() == 4);
  REQUIRE(to.size() == 4);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::find(t.begin(), t.end(), left) != t.end() ||
           std::find(t.begin(), t.end(), right) != t.end();
  });
  // The vertices in the middle become unused.
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t n = (k + 1) % 4;
    mesh.triangles.push_back({from[k], from[n], to[k]});
    mesh.triangles.push_back({from[n], to[n], to[k]});
  }
  return mesh;
}

/// A box of 1 x 2 x 3 whose faces are grids of n x n.
Mesh fine_box(std::uint32_t n) {
  Mesh mesh;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
  const auto number = [&](const std::array<std::uint32_t, 3>& at) {
    const auto [found, is_new] =
        numbers.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back({1.0 * at[0] / n, 2.0 * at[1] / n, 3.0 * at[2] / n});
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::uint32_t level : {0U, n}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t k = 0; k < n; ++k) {
          const auto at = [&](std::uint32_t di, std::uint32_t dk) {
            std::array<std::uint32_t, 3> all{};
            all[axis] = level;
            all[(axis + 1) % 3] = i + di;
            all[(axis + 2) % 3] = k + dk;
            return number(all);
          };
          Triangle one{at(0, 0), at(1, 0), at(1, 1)};
          Triangle other{at(0, 0), at(1, 1), at(0, 1)};
          if (level == 0) std::swap(one[1], one[2]);
          if (level == 0) std::swap(other[1], other[2]);
          mesh.triangles.insert(mesh.triangles.end(), {one, other});
        }
      }
    }
  }
  return mesh;
}

/// A wavy floor and a wall that stands on its middle line.
Mesh wall_on_floor(std::uint32_t n) {
  Mesh mesh = wavy_grid(n, n);
  const std::uint32_t row = n + 1;
  const std::uint32_t base = n / 2 * row;
  std::vector<std::uint32_t> below(row);
  for (std::uint32_t c = 0; c <= n; ++c) below[c] = base + c;
  for (std::uint32_t r = 1; r <= n / 2; ++r) {
    std::vector<std::uint32_t> above;
    for (std::uint32_t c = 0; c <= n; ++c) {
      above.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(mesh.positions[base + c] + Vec3{0, 0, 1.0 * r / n});
    }
    for (std::uint32_t c = 0; c < n; ++c) {
      mesh.triangles.push_back({below[c], below[c + 1], above[c + 1]});
      mesh.triangles.push_back({below[c], above[c + 1], above[c]});
    }
    below = above;
  }
  return mesh;
}

/// Bent tubes of radius 0.03 and length 9, open at both ends.
Mesh hairs() {
  constexpr std::uint32_t k_rings = 60;
  constexpr std::uint32_t k_sides = 6;
  Mesh mesh;
  for (std::uint32_t hair = 0; hair < 40; ++hair) {
    Mesh tube;
    for (std::uint32_t ring = 0; ring < k_rings; ++ring) {
      const double along = 0.15 * ring;
      const double bend = std::sin(0.5 * along + hair);
      for (std::uint32_t side = 0; side < k_sides; ++side) {
        const double angle = 2 * 3.14159265358979 * side / k_sides;
        tube.positions.push_back({along, bend + 0.03 * std::cos(angle), 0.03 * std::sin(angle)});
        if (ring == 0) continue;
        const std::uint32_t next = (side + 1) % k_sides;
        const std::uint32_t here = ring * k_sides;
        const std::uint32_t last = here - k_sides;
        tube.triangles.push_back({last + side, last + next, here + next});
        tube.triangles.push_back({last + side, here + next, here + side});
      }
    }
    append(mesh, tube, {0, 0.2 * hair, 0.7 * (hair % 3)});
  }
  return mesh;
}

}  // namespace

TEST_CASE("topology: keep keeps handles at any goal") {
  const Mesh mesh = plate();
  const Validity before = check(mesh);
  REQUIRE(is_clean(mesh));
  REQUIRE(before.border_edges == 0);
  REQUIRE(before.euler == 2 - 2 * 36);
  for (const std::uint64_t goal : {3000U, 300U, 0U}) {
    CAPTURE(goal);
    const Simplifier result = reduced_topology(mesh, goal, TopologyMode::keep);
    CHECK(is_clean(result.mesh()));
    CHECK(check(result.mesh()).euler == before.euler);
    CHECK(check(result.mesh()).components == before.components);
    CHECK(!result.simplifies_topology());
  }
  CHECK(reduced_topology(mesh, 0, TopologyMode::keep).triangles() > 200);
}

TEST_CASE("topology: simplify meets goals that have no room for the handles, and stays manifold") {
  const Mesh mesh = plate();
  const Validity before = check(mesh);
  for (const std::uint64_t goal : {500U, 100U, 20U}) {
    CAPTURE(goal);
    const Simplifier result = reduced_topology(mesh, goal, TopologyMode::simplify);
    CHECK(result.simplifies_topology());
    CHECK(result.triangles() <= goal + 1);
    CHECK(result.triangles() + 2 >= goal);
    CHECK(is_clean(result.mesh()));
    // With few triangles there is no room to close what is pinched off.
    if (goal == 500) CHECK(check(result.mesh()).border_edges == before.border_edges);
    CHECK(check(result.mesh()).euler > before.euler);
  }
}

TEST_CASE("topology: automatic keeps it where the goal is easy, and only there") {
  const Mesh mesh = plate();
  const Validity before = check(mesh);
  const Simplifier easy = reduced_topology(mesh, mesh.triangles.size() / 2);
  CHECK(!easy.simplifies_topology());
  CHECK(check(easy.mesh()).euler == before.euler);
  CHECK(check(easy.mesh()).components == before.components);
  const Simplifier hard = reduced_topology(mesh, 100);
  CHECK(hard.simplifies_topology());
  CHECK(hard.triangles() <= 101);
  CHECK(is_clean(hard.mesh()));
}

TEST_CASE("cells that touch along edges stay closed however they are joined at their corners") {
  // The first two touch along an edge; at one end of it other cells fill the gap.
  const std::vector<Cell> five{{1, 1, 1}, {2, 2, 1}, {1, 1, 2}, {1, 2, 2}, {2, 2, 2}};
  const auto is_one = [&](const Cell& c) {
    return std::find(five.begin(), five.end(), c) != five.end();
  };
  // And many at random.
  Random random(7);
  std::vector<bool> solid(std::size_t{14} * 14 * 14);
  for (std::size_t i = 0; i < solid.size(); ++i) solid[i] = random.below(2) == 0;
  const auto is_random = [&](const Cell& c) -> bool {
    if (std::min({c[0], c[1], c[2]}) == 0 || std::max({c[0], c[1], c[2]}) > 12) return false;
    return solid[(std::size_t{c[0]} * 14 + c[1]) * 14 + c[2]];
  };
  const Mesh few = surface_of_cells({2, 2, 2}, is_one);
  const Mesh many = surface_of_cells({12, 12, 12}, is_random);
  for (const Mesh& mesh : {few, many}) {
    REQUIRE(check(mesh).border_edges == 0);
    REQUIRE(check(mesh).crowded_edges > 0);
    for (const std::size_t share : {1U, 2U, 5U}) {
      CAPTURE(share);
      const Simplifier result = reduced_topology(mesh, mesh.triangles.size() / share);
      CHECK(check(result.mesh()).border_edges == 0);
    }
  }
}

TEST_CASE("topology: a second, farther goal may need it given up, too") {
  Simplifier simplifier(wide_torus(60, 30), {});
  simplifier.reduce({200});
  CHECK(simplifier.triangles() == 200);
  CHECK(check(simplifier.mesh()).euler == 0);
  CHECK(!simplifier.simplifies_topology());
  simplifier.reduce({4});
  CHECK(simplifier.simplifies_topology());
  CHECK(simplifier.triangles() <= 5);
}

TEST_CASE("topology: about four triangles of a surface with handles are about four") {
  for (const Mesh& mesh : {wide_torus(60, 30), plate()}) {
    const Simplifier result = reduced_topology(mesh, 4);
    CHECK(result.triangles() >= 1);
    CHECK(result.triangles() <= 5);
    CHECK(is_clean(result.mesh()));
  }
}

TEST_CASE("topology: a thin bridge is kept, or pinched off and cut apart") {
  const Mesh mesh = dumbbell();
  REQUIRE(check(mesh).euler == 2);
  REQUIRE(check(mesh).components == 1);
  REQUIRE(check(mesh).crowded_edges == 0);
  REQUIRE(check(mesh).border_edges == 0);
  const Simplifier kept = reduced_topology(mesh, 100, TopologyMode::keep);
  CHECK(kept.triangles() == 100);
  CHECK(check(kept.mesh()).euler == 2);
  CHECK(check(kept.mesh()).components == 1);
  const Simplifier simplified = reduced_topology(mesh, 40, TopologyMode::simplify);
  CHECK(simplified.triangles() == 40);
  CHECK(is_clean(simplified.mesh()));
  const Validity after = check(simplified.mesh());
  CHECK(after.euler == 2 * static_cast<std::int64_t>(after.components));
}

TEST_CASE("topology: of two specks that of which the rest is near goes first") {
  const Mesh speck = scaled(sphere(1), 0.02);
  for (const bool near_first : {true, false}) {
    CAPTURE(near_first);
    Mesh mesh = sphere(4);
    const Vec3 near{1.05, 0, 0};
    const Vec3 far{0, 3, 0};
    append(mesh, speck, near_first ? near : far);
    append(mesh, speck, near_first ? far : near);
    // A result with room for one of them.
    const Simplifier result = reduced_topology(mesh, 60, TopologyMode::simplify);
    CHECK(result.triangles() == 60);
    const auto left_round = [&](Vec3 place) {
      const std::vector<Vec3>& p = result.mesh().positions;
      return std::any_of(p.begin(), p.end(), [&](Vec3 v) { return length(v - place) < 0.03; });
    };
    CHECK(left_round(far));
    CHECK(!left_round(near));
  }
}

TEST_CASE("topology: a piece is worth more once the piece next to it is gone") {
  const Mesh triangle{{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}}, {{0, 1, 2}}};
  const Mesh tetrahedron = scaled({{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                                   {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}},
                                  0.01);
  for (const Mesh& piece : {triangle, tetrahedron}) {
    const std::size_t size = piece.triangles.size();
    CAPTURE(size);
    // Two pairs: each piece is 0.03 from the other, and 5 from all else.
    Mesh mesh;
    const std::array<Vec3, 4> places = {{{0, 0, 0}, {0, 0, 0.03}, {5, 0, 0}, {5, 0, 0.03}}};
    for (const Vec3 place : places) append(mesh, piece, place);
    const Simplifier result = reduced_topology(mesh, 2 * size, TopologyMode::simplify);
    CHECK(result.triangles() == 2 * size);
    const std::vector<Vec3>& left = result.mesh().positions;
    for (const double x : {0.0, 5.0}) {
      CHECK(std::any_of(left.begin(), left.end(), [&](Vec3 p) { return std::abs(p.x - x) < 1; }));
    }
  }
}

TEST_CASE("topology: leaves go everywhere alike, not from one end on") {
  Mesh mesh;
  constexpr std::uint32_t k_along = 200;
  constexpr std::uint32_t k_across = 10;
  for (std::uint32_t leaf = 0; leaf < k_along * k_across; ++leaf) {
    const Vec3 at = {0.3 * (leaf / k_across), 0.3 * (leaf % k_across), 0.1 * (leaf % 3)};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {at, at + Vec3{1, 0, 0}, at + Vec3{0, 1, 0.2}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const Simplifier result = reduced_topology(mesh, 200, TopologyMode::simplify);
  CHECK(result.triangles() == 200);
  std::array<int, 4> left{};
  for (const Triangle& t : result.mesh().triangles) {
    const double x = result.mesh().positions[t[0]].x / (0.3 * k_along);
    ++left[std::clamp(static_cast<int>(4 * x), 0, 3)];
  }
  for (const int count : left) {
    CHECK(count > 35);
    CHECK(count < 65);
  }
}

TEST_CASE("topology: open tubes that close on the way may be opened again") {
  const Mesh mesh = hairs();
  const Validity before = check(mesh);
  REQUIRE(before.border_edges > 0);
  const std::uint64_t goal = 14 * before.components;
  const Simplifier result = reduced_topology(mesh, goal, TopologyMode::simplify);
  CHECK(result.triangles() <= goal);
  CHECK(is_clean(result.mesh()));
  CHECK(check(result.mesh()).border_edges > goal / 2);
  CHECK(topology_error(mesh, result.mesh()).rms < 0.08);
}

TEST_CASE("topology: needles that stand out far are left") {
  Mesh mesh = sphere(4);
  const auto add_needle = [&](std::size_t triangle, double height) {
    const auto [a, b, c] = mesh.triangles[triangle];
    const Vec3 foot = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) * (1.0 / 3);
    const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(foot * (1 + height));
    mesh.triangles[triangle] = {a, b, tip};
    mesh.triangles.push_back({b, c, tip});
    mesh.triangles.push_back({c, a, tip});
  };
  for (std::size_t i = 0; i < 8; ++i) add_needle(150 * i, i % 2 == 0 ? 1.0 : 0.001);
  REQUIRE(check(mesh).euler == 2);
  const Simplifier result = reduced_topology(mesh, 80, TopologyMode::simplify);
  CHECK(result.triangles() == 80);
  CHECK(is_clean(result.mesh()));
  const std::vector<Vec3>& left = result.mesh().positions;
  CHECK(std::count_if(left.begin(), left.end(), [](Vec3 v) { return length(v) > 1.9; }) == 4);
}

TEST_CASE("what is flat goes before what is nearly flat") {
  const Mesh mesh = grid(100, 100, [](double x, double y) {
    return x < 0.5 ? 0.0 : 1e-6 * std::sin(300 * x) * std::sin(300 * y);
  });
  SimplifyOptions options;
  Simplifier result(mesh, options);
  result.reduce({mesh.triangles.size() * 3 / 5});
  CHECK(result.triangles() == mesh.triangles.size() * 3 / 5);
  CHECK(topology_error(mesh, result.mesh()).rms < 1e-9);
}

TEST_CASE("flat faces and straight edges are exact as long as anything else can go") {
  const Mesh box = fine_box(20);
  REQUIRE(check(box).euler == 2);
  REQUIRE(check(box).border_edges == 0);
  const Simplifier result = reduced_topology(box, box.triangles.size() / 20);
  CHECK(result.triangles() == box.triangles.size() / 20);
  CHECK(is_clean(result.mesh()));
  const double most = 1e-6 * diagonal(box);
  CHECK(DistanceMeter(result.mesh(), 1).measure(box.positions).max <= most);
  CHECK(DistanceMeter(box, 1).measure(result.mesh().positions).max <= most);
  CHECK(topology_error(box, result.mesh()).max <= most);
}

TEST_CASE("each face twice, once a side, simplifies as once") {
  const Mesh single = wide_torus(80, 40);
  const double once = topology_error(single, reduced_topology(single, 400).mesh()).rms;
  Random random(5);
  Mesh twice{single.positions, {}};
  for (const Triangle& t : single.triangles) {
    Triangle front = t;
    Triangle back{t[1], t[0], t[2]};
    if (random.below(2) == 0) std::swap(front, back);
    twice.triangles.insert(twice.triangles.end(), {front, back});
  }
  const Simplifier result = reduced_topology(twice, 400);
  CHECK(result.dropped_duplicate() == single.triangles.size());
  CHECK(result.triangles() == 400);
  CHECK(is_clean(result.mesh()));
  CHECK(topology_error(single, result.mesh()).rms <= 1.02 * once);
}

TEST_CASE("triangles that are turned over cost nothing") {
  const Mesh in_order = wide_torus(80, 40);
  const double best = topology_error(in_order, reduced_topology(in_order, 400).mesh()).rms;
  for (const std::uint32_t per_cent : {1U, 5U, 50U}) {
    CAPTURE(per_cent);
    Mesh mesh = in_order;
    Random random(per_cent);
    for (Triangle& t : mesh.triangles) {
      if (random.below(100) < per_cent) std::swap(t[1], t[2]);
    }
    const Simplifier result = reduced_topology(mesh, 400);
    CHECK(result.triangles() == 400);
    CHECK(is_clean(result.mesh()));
    CHECK(topology_error(in_order, result.mesh()).rms <= 1.02 * best);
  }
}

TEST_CASE("a wall stays on its floor, whichever comes first") {
  constexpr std::uint32_t k_size = 40;
  for (const bool wall_first : {false, true}) {
    CAPTURE(wall_first);
    Mesh mesh = wavy_grid(k_size, k_size);
    const std::size_t of_floor = mesh.triangles.size();
    // The wall does not reach the floor's borders: round its ends the floor is closed.
    const std::uint32_t base = k_size / 2 * (k_size + 1);
    const auto top = static_cast<std::uint32_t>(mesh.positions.size());
    constexpr std::uint32_t k_from = 8;
    constexpr std::uint32_t k_to = 32;
    for (std::uint32_t c = k_from; c <= k_to; ++c) {
      mesh.positions.push_back(mesh.positions[base + c] + Vec3{0, 0, 0.3});
    }
    for (std::uint32_t c = k_from; c < k_to; ++c) {
      const std::uint32_t above = top + c - k_from;
      mesh.triangles.push_back({base + c, base + c + 1, above + 1});
      mesh.triangles.push_back({base + c, above + 1, above});
    }
    if (wall_first) {
      std::rotate(mesh.triangles.begin(),
                  mesh.triangles.begin() + static_cast<std::ptrdiff_t>(of_floor),
                  mesh.triangles.end());
    }
    REQUIRE(check(mesh).components == 1);
    REQUIRE(check(mesh).crowded_edges == k_to - k_from);
    for (const std::uint64_t goal : {std::uint64_t{mesh.triangles.size()}, std::uint64_t{400}}) {
      const Simplifier result = reduced_topology(mesh, goal);
      CHECK(check(result.mesh()).components == 1);
      CHECK(check(result.mesh()).crowded_edges > 0);
    }
  }
}

TEST_CASE("three sheets that meet in a line reduce along it") {
  constexpr std::uint32_t k_size = 40;
  const Mesh mesh = wall_on_floor(k_size);
  REQUIRE(check(mesh).crowded_edges == k_size);
  const Simplifier result = reduced_topology(mesh, 400);
  CHECK(result.triangles() == 400);
  const Validity after = check(result.mesh());
  CHECK(after.degenerate + after.duplicate + after.no_area + after.unused == 0);
  CHECK(after.euler == 1);
  CHECK(after.components == 1);
  CHECK(after.crowded_edges >= 4);
  CHECK(after.crowded_edges <= k_size / 2);
  CHECK(topology_error(mesh, result.mesh()).rms <= 1e-3 * diagonal(mesh));
}
