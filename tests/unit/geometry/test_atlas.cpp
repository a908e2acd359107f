// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/util/errors.hpp>

#include "atlas_checks.hpp"
#include "geometry/random_unit.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

double solid_area(const Mesh& mesh, std::size_t t) {
  const auto [a, b, c] = mesh.triangles[t];
  return length(
             cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a])) /
         2;
}

/// The lowest texel density of a triangle, as a ratio of the density meant for all.
double least_density(const Mesh& mesh, const Atlas& atlas, std::uint32_t side) {
  double least = HUGE_VAL;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double usual = solid_area(mesh, t) * atlas.texels_per_unit * atlas.texels_per_unit;
    if (usual < 0.5) continue;  // too small: rounding shows
    least = std::min(least, texel_area(texel_corners(atlas, t, side)) / usual);
  }
  return least;
}

/// Pieces of one triangle each, which touch nothing.
Mesh confetti(std::uint32_t pieces) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < pieces; ++i) {
    for (std::uint64_t k = 0; k < 3; ++k) {
      const std::uint64_t n = 9 * std::uint64_t{i} + 3 * k;
      mesh.positions.push_back({3.0 * i + random_unit(n), random_unit(n + 1), random_unit(n + 2)});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// A ramp that winds up `turns` times round a shaft: flat enough for one chart, which would overlap
/// itself.
Mesh spiral_ramp(int turns) {
  constexpr int k_steps = 24;
  const double turn = 2 * std::acos(-1.0);
  Mesh mesh;
  for (int i = 0; i <= turns * k_steps; ++i) {
    const double angle = turn * i / k_steps;
    const double x = std::cos(angle), y = std::sin(angle), z = 0.01 * i;
    mesh.positions.push_back({x, y, z});
    mesh.positions.push_back({2 * x, 2 * y, z});
    if (i == 0) continue;
    const auto at = static_cast<std::uint32_t>(2 * i);
    mesh.triangles.push_back({at - 2, at - 1, at + 1});
    mesh.triangles.push_back({at - 2, at + 1, at});
  }
  return mesh;
}

}  // namespace

TEST_CASE("an atlas of a smooth surface is even, dense and without overlaps") {
  for (const Mesh& mesh : {icosphere(4), torus(60, 30)}) {
    const Atlas atlas = checked_atlas(mesh, {.texture_size = 512});
    CHECK(atlas.margin_texels == 4);
    CHECK(atlas.charts >= 6);
    CHECK(atlas.charts <= 40);
    CHECK(atlas.coverage > 0.4);
    CHECK(least_density(mesh, atlas, 512) > 0.55);
    const double area = std::accumulate(atlas.uvs.begin(), atlas.uvs.end(), 0.0,
                                        [&, t = std::size_t{0}](double sum, const auto&) mutable {
                                          return sum + texel_area(texel_corners(atlas, t++, 512));
                                        });
    CHECK(area / (512.0 * 512.0) == doctest::Approx(atlas.coverage).epsilon(1e-3));
  }
}

TEST_CASE("a flat sheet is one chart that fills the picture") {
  const Atlas atlas = checked_atlas(grid(20, 20), {.texture_size = 256});
  CHECK(atlas.charts == 1);
  CHECK(atlas.coverage > 0.9);
  CHECK(least_density(grid(20, 20), atlas, 256) > 0.99);
}

TEST_CASE("charts are connected and the corners at an inner vertex agree") {
  const Mesh mesh = torus(40, 20);
  const Atlas atlas = make_atlas(mesh, {.texture_size = 512});
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::array<float, 2>>> places;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      places[{atlas.chart_of[t], mesh.triangles[t][k]}].insert(atlas.uvs[t][k]);
    }
  }
  for (const auto& [key, at] : places) CHECK(at.size() == 1);
}

TEST_CASE("a surface that would overlap itself is divided") {
  const Atlas atlas = checked_atlas(spiral_ramp(3), {.texture_size = 256});
  CHECK(atlas.charts >= 3);
  CHECK(atlas.charts <= 8);
}

TEST_CASE("threads change nothing of an atlas") {
  const Mesh mesh = in_memory(*generate_mesh(Shape::torus, 5000));
  const Atlas one = make_atlas(mesh, {.texture_size = 512, .threads = 1});
  const Atlas four = make_atlas(mesh, {.texture_size = 512, .threads = 4});
  CHECK(one.uvs == four.uvs);
  CHECK(one.chart_of == four.chart_of);
}

TEST_CASE("generated shapes have atlases") {
  for (const Shape shape : {Shape::foam, Shape::block, Shape::terrain, Shape::shell, Shape::dust}) {
    const Mesh mesh = in_memory(*generate_mesh(shape, 4000));
    const Atlas atlas = checked_atlas(mesh, {.texture_size = 1024});
    CHECK(atlas.margin_texels == 4);
    CHECK(atlas.coverage > 0.2);
    CHECK(least_density(mesh, atlas, 1024) > 0.2);
  }
}

TEST_CASE("nothing, one triangle, and triangles without area have an atlas") {
  CHECK(make_atlas({}, {}).charts == 0);
  const Mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const Atlas of_one = checked_atlas(one, {.texture_size = 64});
  CHECK(of_one.charts == 1);
  CHECK(of_one.coverage > 0.3);

  // Two equal corners, three in a line, three in one point; then a triangle beside them.
  Mesh thin{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}},
            {{0, 1, 1}, {0, 1, 2}, {2, 3, 4}}};
  const Atlas of_thin = checked_atlas(thin, {.texture_size = 64});
  CHECK(of_thin.charts == 0);
  CHECK(of_thin.coverage == 0);
  thin.positions.push_back({0, 1, 0});
  thin.triangles.push_back({0, 2, 5});
  const Atlas beside = checked_atlas(thin, {.texture_size = 64});
  CHECK(beside.charts == 1);
  CHECK(texel_area(texel_corners(beside, 0, 64)) == 0);
  CHECK(beside.uvs[0][0] != std::array<float, 2>{0.5F, 0.5F});
}

TEST_CASE("edges of many triangles, and faces on both sides, do not disturb") {
  // Five leaves of a book, each seen from both sides.
  Mesh book;
  book.positions = {{0, 0, 0}, {0, 0, 1}};
  for (std::uint32_t i = 0; i < 5; ++i) {
    book.positions.push_back({std::cos(i * 0.3), std::sin(i * 0.3), 0});
    book.positions.push_back({std::cos(i * 0.3), std::sin(i * 0.3), 1});
    const std::uint32_t a = 2 * i + 2, b = a + 1;
    for (const Triangle& t : {Triangle{0, a, b}, Triangle{0, b, 1}}) {
      book.triangles.push_back(t);
      book.triangles.push_back({t[0], t[2], t[1]});
    }
  }
  const Atlas atlas = checked_atlas(book, {.texture_size = 256});
  CHECK(atlas.charts <= 10);
  CHECK(least_density(book, atlas, 256) > 0.5);
}

TEST_CASE("triangles of random corners have an atlas") {
  Mesh mesh;
  for (std::uint64_t i = 0; i < 60; ++i) {
    mesh.positions.push_back({random_unit(3 * i), random_unit(3 * i + 1), random_unit(3 * i + 2)});
  }
  for (std::uint64_t i = 0; i < 400; ++i) {
    Triangle t{};
    for (std::uint64_t k = 0; k < 3; ++k) {
      t[k] = static_cast<std::uint32_t>(60 * random_unit(1000 + 3 * i + k));
    }
    mesh.triangles.push_back(t);
  }
  const Atlas atlas = checked_atlas(mesh, {.texture_size = 512});
  CHECK(least_density(mesh, atlas, 512) > 0.15);
}

TEST_CASE("margins shrink where there are too many pieces, and it is told") {
  const Mesh few = confetti(300);
  CHECK(checked_atlas(few, {.texture_size = 512}).margin_texels == 4);
  const Mesh many = confetti(6'000);
  const Atlas atlas = checked_atlas(many, {.texture_size = 640});
  CHECK(atlas.charts == 6'000);
  CHECK(atlas.margin_texels >= 1);
  CHECK(atlas.margin_texels < 4);
  CHECK(atlas.coverage > 0.1);
  // More pieces than texels.
  const Atlas heap = make_atlas(many, {.texture_size = 40});
  CHECK(heap.margin_texels == 0);
  for (const auto& uvs : heap.uvs) {
    for (const auto& [u, v] : uvs) REQUIRE(std::min({u, v, 1 - u, 1 - v}) >= 0);
  }
}

TEST_CASE("the unit of length is of no account") {
  Mesh mesh = icosphere(2);
  const Atlas usual = make_atlas(mesh, {.texture_size = 256});
  for (const double scale : {1e-12, 1e12}) {
    Mesh other = mesh;
    for (Vec3& p : other.positions) p = p * scale + Vec3{scale, 0, 0};
    const Atlas atlas = checked_atlas(other, {.texture_size = 256});
    CHECK(atlas.coverage == doctest::Approx(usual.coverage).epsilon(0.2));
  }
}

TEST_CASE("a texture of no size, or a vast one, is refused") {
  CHECK_THROWS_AS(make_atlas(icosphere(0), {.texture_size = 0}), UsageError);
  CHECK_THROWS_AS(make_atlas(icosphere(0), {.texture_size = 100'000}), UsageError);
  CHECK(make_atlas(icosphere(0), {.texture_size = 1}).uvs.size() == 20);
  CHECK(make_atlas(icosphere(0), {.texture_size = 16}).uvs.size() == 20);
}
