// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <limits>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// Two spheres that share one vertex: a bow tie.
Mesh joined_spheres() {
  Mesh mesh = sphere(3);
  append(mesh, sphere(3), {2, 0, 0});
  const auto second = static_cast<std::uint32_t>(mesh.positions.size() / 2 + 1);
  REQUIRE(mesh.positions[0] == mesh.positions[second]);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = v == second ? 0 : v;
  }
  return mesh;
}

/// Three wings on one spine: its edges have three triangles.
Mesh three_wings() {
  Mesh mesh;
  constexpr std::uint32_t k_size = 12;
  constexpr std::uint32_t k_row = k_size + 1;
  for (std::uint32_t wing = 0; wing < 3; ++wing) {
    const double angle = 2 * std::numbers::pi * wing / 3;
    Mesh one = flat_grid(k_size, k_size);
    for (Vec3& p : one.positions) p = {p.x * std::cos(angle), p.x * std::sin(angle), p.y};
    append(mesh, one, {});
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      const std::uint32_t local = v % (k_row * k_row);
      if (local % k_row == 0) v = local;
    }
  }
  return mesh;
}

/// Cells in rows, each a cube of twelve triangles; where two meet, their diagonals may cross.
Mesh block_of_cells(std::uint32_t size) {
  Mesh mesh;
  const std::uint32_t row = size + 1;
  for (std::uint32_t i = 0; i < row * row * row; ++i) {
    const Vec3 at{1.0 * (i % row), 1.0 * (i / row % row), 1.0 * (i / (row * row))};
    mesh.positions.push_back(at * (1.0 / size));
  }
  const std::array<std::uint32_t, 3> steps = {1, row, row * row};
  for (std::uint32_t cell = 0; cell < size * size * size; ++cell) {
    const std::uint32_t first =
        cell % size + cell / size % size * row + cell / (size * size) * row * row;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t u = steps[(axis + 1) % 3];
      const std::uint32_t v = steps[(axis + 2) % 3];
      const std::uint32_t far = first + steps[axis];
      mesh.triangles.push_back({first, first + v, first + u + v});
      mesh.triangles.push_back({first, first + u + v, first + u});
      mesh.triangles.push_back({far, far + u, far + v});
      mesh.triangles.push_back({far + u, far + u + v, far + v});
    }
  }
  return mesh;
}

/// Pieces of five vertices and all triangles between them: each edge has three.
Mesh pyramids_of_cells(std::uint32_t pieces) {
  Mesh mesh;
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    const std::uint32_t first = 5 * piece;
    const double x = 3.0 * piece;
    for (const Vec3 at : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      mesh.positions.push_back(at + Vec3{x, 0, 0});
    }
    mesh.positions.push_back({x + 0.2, 0.3, 0.25});
    for (std::uint32_t a = 0; a < 5; ++a) {
      for (std::uint32_t b = a + 1; b < 5; ++b) {
        for (std::uint32_t c = b + 1; c < 5; ++c) {
          mesh.triangles.push_back({first + a, first + b, first + c});
        }
      }
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("degenerate and duplicate triangles are dropped and counted") {
  Mesh mesh = sphere(3);
  const std::uint64_t good = mesh.triangles.size();
  const Triangle t = mesh.triangles[5];
  mesh.triangles.insert(mesh.triangles.begin() + 20, {t[0], t[0], t[1]});
  mesh.triangles.insert(mesh.triangles.begin() + 30, {t[2], t[2], t[2]});
  mesh.triangles.push_back({t[1], t[2], t[0]});
  mesh.triangles.push_back({t[1], t[0], t[2]});
  Simplifier simplifier(mesh, {});
  CHECK(simplifier.dropped_degenerate() == 2);
  CHECK(simplifier.dropped_duplicate() == 2);
  CHECK(simplifier.triangles() == good);
  CHECK(simplifier.mesh().triangles[5] == t);
  simplifier.reduce({100});
  CHECK(simplifier.triangles() == 100);
  CHECK(is_clean(simplifier.mesh()));
}

TEST_CASE("unused vertices are dropped") {
  Mesh mesh = tetrahedron();
  mesh.positions.insert(mesh.positions.begin() + 1, Vec3{9, 9, 9});
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v += v > 0 ? 1 : 0;
  }
  CHECK(same_bytes(Simplifier(mesh, {}).mesh(), tetrahedron()));
}

TEST_CASE("closed surfaces that touch in a vertex are taken apart") {
  Simplifier simplifier(joined_spheres(), {});
  CHECK(check(simplifier.mesh()).components == 2);
  simplifier.reduce({60});
  CHECK(simplifier.triangles() == 60);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).components == 2);
  CHECK(check(simplifier.mesh()).euler == 4);
}

TEST_CASE("a spine of three wings merges along itself and stays one") {
  const Mesh mesh = three_wings();
  const Validity before = check(mesh);
  REQUIRE(before.crowded_edges == 12);
  SimplifyOptions options;
  options.lines.topology = TopologyMode::keep;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({700});  // near the goal, so that edges collapse in order from here on
  simplifier.reduce({18});
  CHECK(simplifier.max_cost() <= 1e-12);
  const Mesh& result = simplifier.mesh();
  const Validity after = check(result);
  CHECK(after.crowded_edges >= 1);
  CHECK(after.crowded_edges <= 3);
  CHECK(after.euler == before.euler);
  CHECK(after.components == 1);
  CHECK(after.degenerate + after.duplicate + after.no_area == 0);
  CHECK(simplifier.triangles() == 18);
  const auto on_spine = std::count_if(result.positions.begin(), result.positions.end(), [](Vec3 p) {
    return std::abs(p.x) < 1e-6 && std::abs(p.y) < 1e-6;
  });
  CHECK(on_spine == static_cast<std::ptrdiff_t>(after.crowded_edges) + 1);
  CHECK(area(result) == doctest::Approx(3));
}

TEST_CASE("the outermost walls of a block of cells do not go first") {
  const Mesh mesh = block_of_cells(10);
  Simplifier simplifier(mesh, {});
  const std::uint64_t goal = simplifier.mesh().triangles.size() / 5;
  simplifier.reduce({.triangles = goal}, {});
  const Mesh& result = simplifier.mesh();
  CHECK(result.triangles.size() <= goal);
  CHECK(result.triangles.size() + goal / 1000 >= goal);
  const auto distance = DistanceMeter(result, 1).measure(sample_surface(mesh, {20'000, 1}).points);
  CHECK(distance.rms < 0.08);
}

TEST_CASE("a goal that no collapse meets is missed by few triangles, not left") {
  const Mesh mesh = pyramids_of_cells(60);
  Simplifier simplifier(mesh, {});
  const std::uint64_t all = simplifier.mesh().triangles.size();
  REQUIRE(all == 600);
  simplifier.reduce({.triangles = all - 2}, {});
  CHECK(simplifier.mesh().triangles.size() < all);
  CHECK(simplifier.mesh().triangles.size() >= all - 2 - all / 50);
}

TEST_CASE("neighbours of opposite orientation are turned") {
  Mesh mesh = flat_grid(20, 20);
  for (Triangle& t : mesh.triangles) {
    if (mesh.positions[t[0]].x >= 0.6) std::swap(t[1], t[2]);
  }
  REQUIRE(check(mesh).crowded_edges == 20);
  Simplifier simplifier(mesh, {});
  CHECK(simplifier.mesh().triangles == flat_grid(20, 20).triangles);
  simplifier.reduce({40, 1e-12});
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).euler == 1);
  CHECK(simplifier.triangles() == 40);
  CHECK(area(simplifier.mesh()) == doctest::Approx(1));
}

TEST_CASE("triangles of no area neither crash nor spread") {
  Mesh mesh = wavy_grid(30, 30);
  // Vertices moved onto a neighbour, and a row moved onto the row before.
  for (std::uint32_t v = 100; v < 800; v += 37) mesh.positions[v] = mesh.positions[v + 1];
  for (std::uint32_t v = 403; v < 433; ++v) {
    mesh.positions[v] = mesh.positions[v - 31] + Vec3{0, 0, 0};
  }
  const Validity before = check(mesh);
  REQUIRE(before.no_area > 50);
  for (const std::uint64_t goal : {1500U, 1000U, 500U, 100U}) {
    CAPTURE(goal);
    Simplifier simplifier(mesh, {});
    simplifier.reduce({goal});
    const Validity after = check(simplifier.mesh());
    CHECK(after.no_area <= before.no_area);
    CHECK(after.degenerate + after.duplicate + after.crowded_edges == 0);
    CHECK(after.euler == 1);
    CHECK(simplifier.triangles() >= goal);
  }
}

TEST_CASE("vertices that are not finite stay") {
  Mesh mesh = wavy_grid(20, 20);
  mesh.positions[100].y = std::numeric_limits<double>::quiet_NaN();
  mesh.positions[200].x = HUGE_VAL;
  Simplifier simplifier(mesh, {});
  simplifier.reduce({200});
  CHECK(simplifier.triangles() == 200);
  const auto& positions = simplifier.mesh().positions;
  CHECK(std::count_if(positions.begin(), positions.end(), [](Vec3 p) { return !is_finite(p); }) ==
        2);
}

TEST_CASE("a hub of many triangles is not walked once an edge") {
  constexpr std::uint32_t k_rim = 200000;
  for (const bool closed : {true, false}) {
    CAPTURE(closed);
    Mesh mesh;
    mesh.positions.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < k_rim; ++i) {
      const double angle = 2 * std::numbers::pi * i / k_rim;
      mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
      const bool last = i + 1 == k_rim;
      if (closed || !last) mesh.triangles.push_back({0, i + 1, last ? 1 : i + 2});
    }
    Simplifier simplifier(mesh, {});
    simplifier.reduce({50});
    CHECK(simplifier.triangles() == 50);
    CHECK(is_clean(simplifier.mesh()));
    CHECK(check(simplifier.mesh()).euler == 1);
  }
}

namespace {

/// Triangles between random points, of which some coincide.
Mesh random_soup(Random& random) {
  Mesh mesh;
  const std::uint32_t vertices = 5 + random.below(40);
  const std::uint32_t steps = 1 + random.below(20);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const auto coordinate = [&] { return static_cast<double>(random.below(steps)); };
    const double x = coordinate();
    const double y = coordinate();
    mesh.positions.push_back({x, y, coordinate()});
  }
  const std::uint32_t triangles = 5 + random.below(120);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t a = random.below(vertices);
    const std::uint32_t b = random.below(vertices);
    mesh.triangles.push_back({a, b, random.below(vertices)});
  }
  return mesh;
}

/// A torus or a sheet with noise, holes, and points glued together: bow ties and crowded edges.
Mesh random_surface(Random& random, bool closed) {
  Mesh mesh = closed ? wide_torus(8 + random.below(8), 6 + random.below(8))
                     : wavy_grid(6 + random.below(12), 6 + random.below(12));
  for (Vec3& p : mesh.positions) {
    p = p + Vec3{random.unit(), random.unit(), random.unit()} * (0.02 * random.below(8));
  }
  const std::uint32_t hole = random.below(3) * 8 + 1;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return random.below(hole) == 1; });
  for (std::uint32_t glued = random.below(4); glued > 0; --glued) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    const std::uint32_t from = random.below(n);
    const std::uint32_t to = random.below(n);
    for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), from, to);
  }
  return mesh;
}

/// Checks what holds in any topology mode, and what holds if the topology is kept.
void check_result(const Simplifier& simplifier, const Validity& before, TopologyMode topology) {
  const Validity after = check(simplifier.mesh());
  CHECK(after.bad_index + after.degenerate + after.duplicate == 0);
  CHECK(after.no_area <= before.no_area);
  CHECK(after.crowded_edges <= before.crowded_edges);
  if (topology != TopologyMode::keep && topology != TopologyMode::keep_while_fair) return;
  CHECK(after.components == before.components);
  CHECK(after.euler == before.euler);
}

constexpr std::array<TopologyMode, 4> k_modes{TopologyMode::automatic, TopologyMode::keep,
                                              TopologyMode::simplify,
                                              TopologyMode::keep_while_fair};

}  // namespace

TEST_CASE("random soup never breaks") {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    for (const TopologyMode topology : k_modes) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(topology));
      Random random(seed);
      const Mesh mesh = random_soup(random);
      SimplifyOptions options;
      options.locked_vertices = random.below(4);
      options.lines.topology = topology;
      Simplifier simplifier(mesh, options);
      const Validity before = check(simplifier.mesh());
      CHECK(simplifier.dropped_degenerate() == check(mesh).degenerate);
      CHECK(simplifier.dropped_duplicate() == check(mesh).duplicate);
      simplifier.reduce({random.below(static_cast<std::uint32_t>(mesh.triangles.size()))});
      check_result(simplifier, before, topology);
      simplifier.reduce({0});
      check_result(simplifier, before, topology);
      CHECK(check(simplifier.mesh()).unused <= options.locked_vertices);
    }
  }
}

TEST_CASE("surfaces with random holes, handles and flips never break") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    for (const TopologyMode topology : k_modes) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(topology));
      Random random(seed);
      const Mesh mesh = random_surface(random, seed % 2 == 0);
      SimplifyOptions options;
      options.locked_vertices = random.below(20);
      options.positions = PositionType::float32;
      options.lines.topology = topology;
      Simplifier simplifier(mesh, options);
      const Validity before = check(simplifier.mesh());
      simplifier.reduce({random.below(100)});
      check_result(simplifier, before, topology);
    }
  }
}
