// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/simplify.hpp>

#include "test_simplify_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

/// Moves the vertices that `first` picks to the head of the list, where locked ones stand.
template <typename First>
std::pair<Mesh, std::uint32_t> with_head(const Mesh& mesh, const First& first) {
  Mesh result;
  std::vector<std::uint32_t> index(mesh.positions.size());
  std::uint32_t head = 0;
  for (const bool wanted : {true, false}) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (first(mesh.positions[v]) != wanted) continue;
      index[v] = static_cast<std::uint32_t>(result.positions.size());
      result.positions.push_back(mesh.positions[v]);
    }
    if (wanted) head = static_cast<std::uint32_t>(result.positions.size());
  }
  for (const Triangle& t : mesh.triangles) {
    result.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  }
  return {result, head};
}

bool on_rim(Vec3 p) {
  return p.x == 0 || p.x == 1 || p.y == 0 || p.y == 1;
}

/// A wavy sheet of tiles that share no vertices and have sides like jigsaw pieces.
Mesh tiles(std::uint32_t across, std::uint32_t cells) {
  const Mesh tile = flat_grid(cells, cells);
  Mesh mesh;
  for (std::uint32_t i = 0; i < across * across; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : tile.positions) {
      const double u = (p.x + i % across) / across;
      const double v = (p.y + i / across) / across;
      const double x = u + 0.01 * std::sin(60 * v);
      const double y = v + 0.01 * std::sin(60 * u);
      mesh.positions.push_back({x, y, 0.05 * std::sin(20 * x) * std::sin(17 * y)});
    }
    for (const Triangle& t : tile.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("a flat plane collapses for nothing and keeps its outline") {
  Simplifier simplifier(flat_grid(40, 30), {});
  simplifier.reduce({2, 1e-12});
  CHECK(simplifier.triangles() < 60);
  CHECK(simplifier.max_cost() <= 1e-12);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).euler == 1);
  CHECK(area(simplifier.mesh()) == doctest::Approx(1).epsilon(1e-6));
  Box box;
  for (const Vec3 p : simplifier.mesh().positions) box.add(p);
  CHECK(box.diagonal() == doctest::Approx(std::sqrt(2.0)).epsilon(1e-6));
}

TEST_CASE("flat ground inside a locked rim costs exactly nothing") {
  const auto [mesh, head] = with_head(flat_grid(40, 40), on_rim);
  SimplifyOptions options;
  options.locked_vertices = head;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({0, 0.0});
  CHECK(simplifier.max_cost() == 0);
  CHECK(simplifier.triangles() < 400);
  CHECK(is_clean(simplifier.mesh()));
}

TEST_CASE("a curved border stays where it is") {
  // A disc.
  Mesh disc;
  constexpr std::uint32_t k_around = 120;
  constexpr std::uint32_t k_rings = 20;
  disc.positions.push_back({});
  for (std::uint32_t r = 1; r <= k_rings; ++r) {
    for (std::uint32_t i = 0; i < k_around; ++i) {
      const double angle = 2 * std::numbers::pi * i / k_around;
      disc.positions.push_back(Vec3{std::cos(angle), std::sin(angle), 0} * (1.0 * r / k_rings));
    }
  }
  for (std::uint32_t i = 0; i < k_around; ++i) {
    const std::uint32_t j = (i + 1) % k_around;
    disc.triangles.push_back({0, 1 + i, 1 + j});
    for (std::uint32_t r = 0; r + 1 < k_rings; ++r) {
      const std::uint32_t low = 1 + r * k_around;
      disc.triangles.push_back({low + i, low + k_around + i, low + k_around + j});
      disc.triangles.push_back({low + i, low + k_around + j, low + j});
    }
  }
  Simplifier simplifier(disc, {});
  simplifier.reduce({60});
  CHECK(simplifier.triangles() == 60);
  CHECK(is_clean(simplifier.mesh()));
  CHECK(check(simplifier.mesh()).euler == 1);
  CHECK(area(simplifier.mesh()) == doctest::Approx(std::numbers::pi).epsilon(0.02));
}

TEST_CASE("open borders take no more triangles than the surface gives") {
  const Mesh mesh = tiles(8, 12);
  Simplifier simplifier(mesh, {});
  simplifier.reduce({mesh.triangles.size() / 10});
  const Mesh& result = simplifier.mesh();
  // 7.0e-4 and 7.2e-4 if borders weigh as much as creases.
  CHECK(measure_distance(mesh, result, {.samples = 50'000}).rms < 6.5e-4);
  CHECK(measure_distance(result, mesh, {.samples = 50'000}).rms < 6.5e-4);
}

TEST_CASE("a hole stays a hole as long as it may, and goes for a goal that has no room for it") {
  Mesh mesh = wavy_grid(30, 30);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vec3 p = mesh.positions[t[0]];
    return std::abs(p.x - 0.5) < 0.1 && std::abs(p.y - 0.5) < 0.1;
  });
  SimplifyOptions keep;
  keep.lines.topology = TopologyMode::keep;
  Simplifier kept(mesh, keep);
  kept.reduce({0});
  CHECK(is_clean(kept.mesh()));
  CHECK(check(kept.mesh()).euler == 0);
  CHECK(check(kept.mesh()).border_edges >= 6);
  Simplifier simplified(mesh, {});
  simplified.reduce({100});
  CHECK(!simplified.simplifies_topology());
  CHECK(check(simplified.mesh()).euler == 0);
  simplified.reduce({2});
  CHECK(simplified.simplifies_topology());
  CHECK(is_clean(simplified.mesh()));
  CHECK(simplified.triangles() == 2);
}

TEST_CASE("locked vertices neither move nor go, used or not") {
  auto [mesh, head] = with_head(wavy_grid(40, 40), on_rim);
  // One more locked vertex that no triangle uses, in front.
  mesh.positions.insert(mesh.positions.begin(), Vec3{7, 7, 7});
  for (Triangle& t : mesh.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
  ++head;
  SimplifyOptions options;
  options.locked_vertices = head;
  Simplifier simplifier(mesh, options);
  simplifier.reduce({0});
  const Mesh& result = simplifier.mesh();
  REQUIRE(result.positions.size() >= head);
  for (std::uint32_t v = 0; v < head; ++v) CHECK(result.positions[v] == mesh.positions[v]);
  const Validity validity = check(result);
  CHECK(validity.unused == 1);
  CHECK(validity.border_edges == head - 1);
  CHECK(validity.euler == 1);
  CHECK(validity.degenerate + validity.duplicate + validity.no_area + validity.crowded_edges == 0);
  CHECK(simplifier.triangles() < 400);
  CHECK(simplifier.free_triangles() < simplifier.triangles());
}

TEST_CASE("with a seam only edges at it collapse") {
  const Mesh mesh = wavy_grid(40, 40);
  SimplifyOptions options;
  for (const Vec3 p : mesh.positions) options.seam.push_back(std::abs(p.x - 0.5) < 0.03 ? 1 : 0);
  Simplifier simplifier(mesh, options);
  REQUIRE(simplifier.seam().size() == simplifier.mesh().positions.size());
  simplifier.reduce({2600});
  CHECK(simplifier.triangles() == 2600);
  CHECK(is_clean(simplifier.mesh()));
  REQUIRE(simplifier.seam().size() == simplifier.mesh().positions.size());
  std::size_t flagged = 0;
  std::size_t moved = 0;
  for (std::size_t v = 0; v < simplifier.seam().size(); ++v) {
    const Vec3 p = simplifier.mesh().positions[v];
    const bool is_new =
        std::find(mesh.positions.begin(), mesh.positions.end(), p) == mesh.positions.end();
    if (simplifier.seam()[v] != 0) ++flagged;
    if (is_new) {
      ++moved;
      CHECK(simplifier.seam()[v] == 1);
    }
  }
  CHECK(flagged > 0);
  CHECK(moved > 0);
  // Everything far from the seam is still there.
  const auto far = [](const Mesh& m) {
    return std::count_if(m.positions.begin(), m.positions.end(), [](Vec3 p) { return p.x < 0.1; });
  };
  CHECK(far(simplifier.mesh()) == far(mesh));
}
