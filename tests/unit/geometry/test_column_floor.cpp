// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/column_floor.hpp>

#include "test_uv_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::simplify_test;

namespace {

constexpr ColumnSet k_uvs{false, true};

std::uint64_t reached(const Mesh& mesh) {
  SimplifyOptions options;
  options.lines.topology = TopologyMode::keep;
  return reduced(mesh, 1, options).triangles.size();
}

/// Charts round random vertices of a surface, each projected along its own direction.
Mesh patches(Mesh mesh, std::uint32_t many) {
  Random random(many);
  std::vector<Vec3> seeds;
  for (std::uint32_t i = 0; i < many; ++i) {
    seeds.push_back(
        mesh.positions[random.below(static_cast<std::uint32_t>(mesh.positions.size()))]);
  }
  return mapped(std::move(mesh), [&](Vec3 p, Vec3 centre) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < seeds.size(); ++i) {
      const bool nearer =
          squared_length(seeds[i] - centre) < squared_length(seeds[nearest] - centre);
      if (nearer) nearest = i;
    }
    const Vec3 n = seeds[nearest];
    const Vec3 across = cross(n, std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    const Vec3 up = cross(n, across);
    return uv(dot(p, across) + 4 * static_cast<double>(nearest), dot(p, up));
  });
}

}  // namespace

TEST_CASE("a mesh without columns has no floor") {
  CHECK(find_column_floor(sphere(2), {true, true}).triangles == 0);
  CHECK(find_column_floor(cube_map(2), {true, false}).corners == 0);
}

TEST_CASE("the floor of regular charts is exact") {
  CHECK(find_column_floor(cube_map(4), k_uvs).corners == 8);
  CHECK(find_column_floor(cube_map(4), k_uvs).triangles == 12);
  for (const int side : {2, 4, 7}) {
    const Mesh flat = chart_grid(flat_grid(56, 56), side);
    const ColumnFloor floor = find_column_floor(flat, k_uvs);
    const auto inner = static_cast<std::uint64_t>((side - 1) * (side - 1));
    CHECK(floor.corners == inner + 4 * (static_cast<std::uint64_t>(side) - 1));
    CHECK(floor.triangles == reached(flat));
  }
  const Mesh tube = unrolled_tube(32, 20);
  CHECK(find_column_floor(tube, k_uvs).corners == 2);
  CHECK(find_column_floor(tube, k_uvs).triangles == reached(tube));
  CHECK(find_column_floor(dart(flat_grid(20, 20)), k_uvs).corners == 2);
}

TEST_CASE("islands keep a triangle each") {
  const Mesh one = dart(wavy_grid(6, 6));
  const Mesh plain = mapped(wavy_grid(6, 6), [](Vec3 p, Vec3) { return uv(p.x, p.y); });
  Mesh many;
  for (int i = 0; i < 30; ++i) {
    append(many, plain, {1.5 * i, 0, 0});
    many.columns.append(plain.columns);
  }
  CHECK(find_column_floor(many, k_uvs).triangles == 30);
  CHECK(reached(many) == 30);
  CHECK(find_column_floor(one, k_uvs).triangles == reached(one));
}

TEST_CASE("charts of two corners go") {
  // A strip in which a triangle at the side, in the middle, is a chart of its own.
  Mesh strip = mapped(flat_grid(12, 4), [](Vec3 p, Vec3 c) {
    const bool apart = c.y < 0.25 && c.x > 0.5 && c.x < 0.75;
    return uv(p.x + (apart ? 3 : 0), p.y);
  });
  CHECK(find_column_floor(strip, k_uvs).corners == 2);
  CHECK(find_column_floor(strip, k_uvs).triangles == 1);
  CHECK(reached(strip) == 1);
}

TEST_CASE("the floor of patches is told to a tenth") {
  for (const std::uint32_t many : {40, 600}) {
    const Mesh ball = patches(sphere(6), many);
    const auto told = static_cast<double>(find_column_floor(ball, k_uvs).triangles);
    CHECK(told == doctest::Approx(static_cast<double>(reached(ball))).epsilon(0.1));
  }
}

TEST_CASE("labels make lines as well") {
  Mesh ball = sphere(4);
  for (const Triangle& t : ball.triangles) {
    const Vec3 p = ball.positions[t[0]] + ball.positions[t[1]] + ball.positions[t[2]];
    ball.columns.labels.push_back((p.x > 0 ? 1U : 0U) + (p.y > 0 ? 2U : 0U) + (p.z > 0 ? 4U : 0U));
  }
  CHECK(find_column_floor(ball, {true, true}).corners == 6);
  CHECK(find_column_floor(ball, {true, true}).triangles == 8);
}

TEST_CASE("floors of parts add up") {
  const Mesh whole = chart_grid(flat_grid(60, 60), 6);
  ColumnFloor sum;
  for (const bool upper : {false, true}) {
    // Each half of the square has the row common to both first.
    Mesh part;
    const std::uint32_t row = 61;
    const std::uint32_t shared = 25 * row;
    for (std::uint32_t v = 0; v < row; ++v) part.positions.push_back(whole.positions[shared + v]);
    const auto number = [&](std::uint32_t v) {
      if (v / row == 25) return v - shared;
      return upper ? v - shared : v + row;
    };
    for (std::uint32_t v = 0; v < whole.positions.size(); ++v) {
      if (upper ? v >= shared + row : v < shared) part.positions.push_back(whole.positions[v]);
    }
    for (std::size_t i = 0; i < whole.triangles.size(); ++i) {
      const auto [a, b, c] = whole.triangles[i];
      if ((std::min({a, b, c}) >= shared) != upper) continue;
      part.triangles.push_back({number(a), number(b), number(c)});
      part.columns.append(whole.columns, i);
    }
    sum += find_column_floor(part, k_uvs, row);
  }
  const ColumnFloor all = find_column_floor(whole, k_uvs);
  CHECK(sum.corners == all.corners);
  CHECK(sum.triangles == all.triangles);
}
