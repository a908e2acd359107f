// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/util/errors.hpp>

#include "test_uv_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

const std::vector<TopologyMode> k_uv_modes = {TopologyMode::automatic, TopologyMode::keep,
                                              TopologyMode::simplify};

SimplifyOptions with(TopologyMode mode) {
  SimplifyOptions options;
  options.lines.topology = mode;
  return options;
}

Uv affine(Vec3 p) {
  return uv(3 * p.x - p.y + 0.25, 0.5 * p.x + 2 * p.y - 7);
}

/// Calls look(position, uv) for all corners.
template <typename Look>
void for_corners(const Mesh& mesh, const Look& look) {
  REQUIRE(mesh.columns.uvs.size() == mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      look(mesh.positions[mesh.triangles[i][k]], mesh.columns.uvs[i][k]);
  }
}

double greatest_error(const Mesh& mesh, Uv (*right)(Vec3)) {
  double greatest = 0;
  for_corners(mesh, [&](Vec3 p, Uv uv) {
    const Uv wanted = right(p);
    greatest = std::max(
        {greatest, std::abs(double{uv[0]} - wanted[0]), std::abs(double{uv[1]} - wanted[1])});
  });
  return greatest;
}

/// Vertices that stay in no order, so that there is something to place.
Mesh shaken_grid(std::uint32_t side, double height) {
  Random random(side);
  Mesh mesh = grid(side, side, [&](double, double) { return height * random.unit(); });
  for (Vec3& p : mesh.positions) {
    if (p.x == 0 || p.x == 1 || p.y == 0 || p.y == 1) continue;
    p.x += (random.unit() - 0.5) / (2 * side);
    p.y += (random.unit() - 0.5) / (2 * side);
  }
  return mesh;
}

}  // namespace

TEST_CASE("on a plane an affine map stays what it is") {
  const Mesh flat = mapped(shaken_grid(70, 0), [](Vec3 p, Vec3) { return affine(p); });
  for (const TopologyMode mode : k_uv_modes) {
    // Rough passes, ranked ones, and the queue.
    for (const std::uint64_t target : {6000, 1000, 60}) {
      CAPTURE(target);
      for (const double scale : {0.0, 0.1}) {
        SimplifyOptions options = with(mode);
        options.lines.uv_scale = scale;
        const Mesh result = reduced(flat, target, options);
        CHECK(result.triangles.size() <= target);
        CHECK(is_clean(result));
        CHECK(count_turned(result) == 0);
        CHECK(greatest_error(result, affine) < 2e-6);
        CHECK(strange_ends(flat, result) == 0);
      }
    }
  }
}

TEST_CASE("charts keep their corners and the places of their seams on the picture") {
  const Mesh flat = chart_grid(shaken_grid(48, 0.002), 4);
  for (const TopologyMode mode : k_uv_modes) {
    for (const std::uint64_t target : {2000, 300, 1}) {
      CAPTURE(target);
      const Mesh result = reduced(flat, target, with(mode));
      CHECK(is_clean(result));
      CHECK(count_turned(result) == 0);
      CHECK(strange_ends(flat, result) == 0);
      CHECK(seams_of(result).size() >= 36);
      if (target > 1) CHECK(result.triangles.size() <= target);
      // Two triangles per chart, except one at each corner of the square, which nothing holds.
      if (target == 1) CHECK(result.triangles.size() == 28);
    }
  }
}

TEST_CASE("a cube map ends as a cube") {
  const Mesh ball = cube_map(5);
  REQUIRE(ball.triangles.size() == 12288);
  CHECK(count_turned(ball) == 0);
  for (const TopologyMode mode : k_uv_modes) {
    for (const std::uint64_t target : {1500, 200, 4}) {
      CAPTURE(target);
      const Mesh result = reduced(ball, target, with(mode));
      CHECK(result.triangles.size() == std::max<std::uint64_t>(target, 12));
      CHECK(is_clean(result));
      CHECK(check(result).border_edges == 0);
      CHECK(count_turned(result) == 0);
      CHECK(strange_ends(ball, result) == 0);
      CHECK(seams_of(result).size() >= 12);
    }
  }
}

TEST_CASE("a tube with one seam keeps it, and what is round it") {
  const Mesh tube = unrolled_tube(96, 64);
  for (const TopologyMode mode : k_uv_modes) {
    const Mesh result = reduced(tube, 600, with(mode));
    CHECK(result.triangles.size() <= 600);
    CHECK(count_turned(result) == 0);
    CHECK(strange_ends(tube, result) == 0);
    for_corners(result, [](Vec3 p, Uv uv) {
      CHECK(uv[1] == doctest::Approx(p.z / 2).epsilon(0.01));
      const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi) - uv[0];
      CHECK(std::abs(turn - std::round(turn)) < 0.005);
      if (uv[0] < 1e-6 || uv[0] > 1 - 1e-6) CHECK(p.x == 1);
    });
  }
}

TEST_CASE("the tip of a slit stays where it is") {
  const Mesh flat = dart(flat_grid(40, 40));
  for (const TopologyMode mode : k_uv_modes) {
    for (const std::uint64_t target : {400, 40, 1}) {
      CAPTURE(target);
      const Mesh result = reduced(flat, target, with(mode));
      CHECK(count_turned(result) == 0);
      CHECK(strange_ends(flat, result) == 0);
      std::size_t tips = 0;
      for (const SeamEdge& seam : seams_of(result)) {
        tips +=
            std::count(seam.ends.begin(), seam.ends.end(), place_of(flat.positions[20 * 41 + 20]));
      }
      CHECK(tips >= 1);
    }
  }
}

TEST_CASE("no triangle turns over on the picture") {
  const auto bent = [](Vec3 p, Vec3) {
    return uv(p.x + 0.02 * std::sin(40 * p.y), p.y + 0.02 * std::sin(45 * p.x));
  };
  const Mesh wavy = mapped(wavy_grid(128, 128), bent);
  REQUIRE(count_turned(wavy) == 0);
  for (const double scale : {0.0, 0.2}) {
    for (const std::uint64_t target : {3000, 300, 30}) {
      SimplifyOptions options;
      options.lines.uv_scale = scale;
      const Mesh result = reduced(wavy, target, options);
      CHECK(result.triangles.size() <= target);
      CHECK(count_turned(result) == 0);
      CHECK(strange_ends(wavy, result) == 0);
    }
  }
}

TEST_CASE("a thin ribbon with a picture keeps its length") {
  constexpr double k_width = 1e-2;
  for (const double height : {0.0, 50.0}) {
    CAPTURE(height);
    Mesh mesh = grid(2, 1000, [&](double, double y) { return height * std::sin(12.6 * y); });
    for (Vec3& p : mesh.positions) p = {p.x * k_width, p.y * 1000, p.z};
    mesh = mapped(mesh, [](Vec3 p, Vec3) { return uv(p.x / k_width, p.y / 1000); });
    Simplifier simplifier(mesh, {});
    simplifier.reduce({80});
    CHECK(simplifier.triangles() == 80);
    CHECK(count_turned(simplifier.mesh()) == 0);
    Box box;
    for (const Vec3& p : simplifier.mesh().positions) box.add(p);
    CHECK(box.hi.y - box.lo.y > 980);
  }
}

TEST_CASE("what bends on the picture is kept where it counts") {
  const auto bent = [](Vec3 p, Vec3) { return uv(p.x + 0.05 * std::sin(12 * p.x), p.y); };
  const Mesh flat = mapped(shaken_grid(100, 0), bent);
  const auto error_with = [&](double scale) {
    SimplifyOptions options;
    options.lines.uv_scale = scale;
    const Mesh result = reduced(flat, 300, options);
    CHECK(count_turned(result) == 0);
    double sum = 0;
    for (std::size_t i = 0; i < result.triangles.size(); ++i) {
      const auto [a, b, c] = result.triangles[i];
      const Vec3 at = result.positions[a];
      const Vec3 centre = (at + result.positions[b] + result.positions[c]) * (1.0 / 3);
      const CornerUvs& t = result.columns.uvs[i];
      const double miss = (double{t[0][0]} + t[1][0] + t[2][0]) / 3 - bent(centre, centre)[0];
      const Vec3 normal = cross(result.positions[b] - at, result.positions[c] - at);
      sum += 0.5 * length(normal) * miss * miss;
    }
    return std::sqrt(sum);
  };
  CHECK(error_with(0.1) < 0.5 * error_with(0));
}

TEST_CASE("what has no place on a picture locks nothing") {
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (const Uv point : {uv(0.3, 0.7), Uv{none, none}, uv(HUGE_VAL, 0)}) {
    const Mesh flat = mapped(wavy_grid(64, 64), [&](Vec3, Vec3) { return point; });
    CHECK(reduced(flat, 200).triangles.size() <= 200);
  }
  const Mesh line = mapped(wavy_grid(64, 64), [](Vec3 p, Vec3) { return uv(p.x, 0.3 * p.x); });
  CHECK(reduced(line, 200).triangles.size() <= 200);
}

TEST_CASE("labels and texture coordinates go together") {
  Mesh mesh = chart_grid(shaken_grid(48, 0.002), 2);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 p = mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]];
    mesh.columns.labels.push_back(p.x + p.y > 3 ? 1 : 0);
  }
  const Mesh result = reduced(mesh, 200);
  CHECK(result.triangles.size() <= 200);
  CHECK(strange_ends(mesh, result) == 0);
  REQUIRE(result.columns.labels.size() == result.triangles.size());
  double area = 0;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const auto [a, b, c] = result.triangles[i];
    const Vec3 at = result.positions[a];
    if (result.columns.labels[i] == 1)
      area += length(cross(result.positions[b] - at, result.positions[c] - at)) / 2;
  }
  CHECK(area == doctest::Approx(0.5).epsilon(0.02));
  SimplifyOptions options;
  options.lines.columns = {false, true};
  CHECK(reduced(mesh, 200, options).columns.set() == ColumnSet{false, true});
  options.lines.columns = {true, false};
  CHECK(reduced(mesh, 200, options).columns.set() == ColumnSet{true, false});
}

TEST_CASE("a label that all triangles have makes no seam heavier") {
  const Mesh mesh = chart_grid(shaken_grid(64, 0.01), 4);
  Mesh labelled = mesh;
  labelled.columns.labels.assign(mesh.triangles.size(), 3);
  const Mesh one = reduced(mesh, 800);
  const Mesh two = reduced(labelled, 800);
  CHECK(same_bytes(one, two));
  CHECK(one.columns.uvs == two.columns.uvs);
}

TEST_CASE("locked vertices keep all of their texture coordinates") {
  const Mesh mesh = chart_grid(shaken_grid(48, 0.002), 3);
  SimplifyOptions options;
  options.locked_vertices = 200;  // four rows and part of a fifth
  const Mesh result = reduced(mesh, 700, options);
  CHECK(result.triangles.size() <= 700);
  const auto wedges_of = [](const Mesh& of) {
    std::vector<std::set<Uv>> wedges(200);
    for (std::size_t i = 0; i < of.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (of.triangles[i][k] < 200) wedges[of.triangles[i][k]].insert(of.columns.uvs[i][k]);
      }
    }
    return wedges;
  };
  CHECK(wedges_of(result) == wedges_of(mesh));
  CHECK(strange_ends(mesh, result) == 0);
}

TEST_CASE("triangles that are dropped or turned take their texture coordinates with them") {
  Mesh mesh = mapped(shaken_grid(40, 0), [](Vec3 p, Vec3) { return affine(p); });
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 7) {
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    std::swap(mesh.columns.uvs[i][1], mesh.columns.uvs[i][2]);
  }
  mesh.triangles.insert(mesh.triangles.begin(), {{0, 0, 1}, mesh.triangles[5]});
  mesh.columns.uvs.insert(mesh.columns.uvs.begin(), {CornerUvs{}, mesh.columns.uvs[5]});
  SimplifyOptions options;
  Simplifier simplifier(mesh, options);
  CHECK(simplifier.turned() > 0);
  CHECK(count_turned(simplifier.mesh()) == 0);
  for (const std::uint64_t target : {1500, 100}) {
    simplifier.reduce({.triangles = target});
    CHECK(greatest_error(simplifier.mesh(), affine) < 2e-6);
  }
}

TEST_CASE("the same texture coordinates, the same bytes") {
  const Mesh mesh = chart_grid(shaken_grid(128, 0.01), 5);
  const Mesh one = reduced(mesh, 1500);
  const Mesh two = reduced(mesh, 1500);
  CHECK(same_bytes(one, two));
  CHECK(one.columns.uvs == two.columns.uvs);
  // The same lines hold if it is reduced in steps.
  Simplifier simplifier(mesh, {});
  for (const std::uint64_t target : {20000, 6000, 1500}) {
    simplifier.reduce({.triangles = target, .last_triangles = 1500, .keep_at = {5000, 3000}});
    CHECK(strange_ends(mesh, simplifier.mesh()) == 0);
  }
  for (const Mesh& kept : simplifier.take_kept()) CHECK(strange_ends(mesh, kept) == 0);
}

TEST_CASE("texture coordinates must be one set a triangle") {
  Mesh mesh = tetrahedron();
  mesh.columns.uvs.resize(3);
  CHECK_THROWS_AS(Simplifier(mesh, {}), UsageError);
}
