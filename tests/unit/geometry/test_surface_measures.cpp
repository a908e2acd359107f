// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/geometry/quantile.hpp>
#include <meshfarm/geometry/surface_measures.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

const double k_pi = std::acos(-1.0);

ShapeMeasures shape(const Mesh& mesh, unsigned threads = 2) {
  ShapeMeter meter(threads);
  meter.add(mesh.positions, mesh.triangles);
  return meter.measures();
}

EdgeLengths edges(const Mesh& mesh) {
  return measure_edge_lengths(mesh, 2);
}

/// A cone without a base, its tip at the top: `count` triangles whose angle at the tip is known.
Mesh cone(std::uint32_t count, double height) {
  Mesh mesh{{{0, 0, height}}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turn = 2 * k_pi * i / count;
    mesh.positions.push_back({std::cos(turn), std::sin(turn), 0});
    mesh.triangles.push_back({0, i + 1, (i + 1) % count + 1});
  }
  return mesh;
}

/// A sheet of 8 x 5 squares, bent by `degrees` along x = 4.
Mesh bent(double degrees) {
  Mesh mesh = test::grid(8, 5);
  const double turn = degrees * k_pi / 180;
  for (Vec3& p : mesh.positions) {
    if (p.x <= 4) continue;
    const double beyond = p.x - 4;
    p = {4 + beyond * std::cos(turn), p.y, beyond * std::sin(turn)};
  }
  return mesh;
}

}  // namespace

TEST_CASE("quantiles are values, and so many are above them") {
  std::vector<double> values;
  for (int i = 100; i > 0; --i) values.push_back(i);
  CHECK(quantile(std::span(values), 0.95) == 95);
  CHECK(quantile(std::span(values), 0.99) == 99);
  CHECK(quantile(std::span(values), 0) == 1);
  CHECK(quantile(std::span(values), 1) == 100);
  std::vector<double> one = {7};
  CHECK(quantile(std::span(one), 0.95) == 7);
  CHECK(quantile(std::span<double>(), 0.95) == 0);
}

TEST_CASE("surface measures: a box, wherever it is and however it is turned") {
  const Mesh mesh = test::box({1, 2, 3});
  CHECK(shape(mesh).area == doctest::Approx(22));
  CHECK(shape(mesh).volume == doctest::Approx(6));
  CHECK(edges(mesh).border == 0);
  CHECK(edges(mesh).feature == doctest::Approx(24));
  Mesh far = mesh;
  for (Vec3& p : far.positions) p = p + Vec3{1e7, -2e7, 3e7};
  CHECK(shape(far).volume == doctest::Approx(6));
  Mesh inside_out = mesh;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  CHECK(shape(inside_out).volume == doctest::Approx(-6));
  CHECK(edges(inside_out).feature == doctest::Approx(24));
  Mesh open = mesh;
  open.triangles.resize(10);  // without the face at x = 1
  CHECK(shape(open).area == doctest::Approx(16));
  CHECK(edges(open).border == doctest::Approx(10));
  CHECK(edges(open).feature == doctest::Approx(14));
  // The same for a soup whose triangles face any way.
  Mesh soup;
  for (const auto& [a, b, c] : open.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : {a, b, c}) soup.positions.push_back(open.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
    if (first % 2 == 0) std::swap(soup.triangles.back()[0], soup.triangles.back()[1]);
  }
  CHECK(edges(soup).border == doctest::Approx(10));
  CHECK(edges(soup).feature == doctest::Approx(14));
}

TEST_CASE("surface measures: a sphere and a torus by their formulas") {
  const Mesh sphere = test::icosphere(5);
  CHECK(shape(sphere).area == doctest::Approx(4 * k_pi).epsilon(0.002));
  CHECK(shape(sphere).volume == doctest::Approx(4 * k_pi / 3).epsilon(0.003));
  CHECK(edges(sphere).feature == 0);
  CHECK(edges(sphere).border == 0);
  // Twenty equal faces, with 41.8 degrees between two of them.
  const Mesh icosahedron = test::icosphere(0);
  const double side = length(icosahedron.positions[0] - icosahedron.positions[11]);
  CHECK(edges(icosahedron).feature == doctest::Approx(30 * side));
  CHECK(shape(icosahedron).smallest_angle_p1 == doctest::Approx(60));
  CHECK(shape(icosahedron).share_below_5 == 0);
  const Mesh torus = test::torus(300, 150);
  CHECK(std::abs(shape(torus).area) == doctest::Approx(4 * k_pi * k_pi * 0.4).epsilon(0.002));
  CHECK(std::abs(shape(torus).volume) ==
        doctest::Approx(2 * k_pi * k_pi * 0.4 * 0.4).epsilon(0.002));
}

TEST_CASE("surface measures: a bent sheet has a feature from 40 degrees on") {
  CHECK(edges(bent(0)).feature == 0);
  CHECK(edges(bent(39)).feature == 0);
  CHECK(edges(bent(41)).feature == doctest::Approx(5));
  CHECK(edges(bent(-120)).feature == doctest::Approx(5));
  CHECK(edges(bent(41)).border == doctest::Approx(26));
  CHECK(shape(bent(41)).area == doctest::Approx(40));
  CHECK(shape(bent(41)).smallest_angle_p1 == doctest::Approx(45));
}

TEST_CASE("surface measures: the angles of a cone") {
  const std::uint32_t count = 90;
  const double height = 2;
  const double slant = std::sqrt(1 + height * height);
  const double tip = 2 * std::asin(std::sin(k_pi / count) / slant) * 180 / k_pi;
  REQUIRE(tip < 5);
  Mesh mesh = cone(count, height);
  CHECK(std::abs(shape(mesh).smallest_angle_p1 - tip) <= 0.0005);
  CHECK(shape(mesh).share_below_5 == 1);
  CHECK(edges(mesh).border == doctest::Approx(2 * count * std::sin(k_pi / count)));
  // Beside nine times as many triangles of 45 degrees.
  test::append(mesh, test::grid(45, 9));
  CHECK(shape(mesh).share_below_5 == doctest::Approx(0.1));
  CHECK(std::abs(shape(mesh).smallest_angle_p1 - tip) <= 0.0005);
  // One triangle in a hundred, and then one fewer.
  Mesh few = test::grid(33, 3);
  test::append(few, cone(count, height));
  few.triangles.resize(200);
  CHECK(std::abs(shape(few).smallest_angle_p1 - tip) <= 0.0005);
  few.triangles.resize(199);
  few.triangles.push_back({0, 1, 35});
  CHECK(shape(few).smallest_angle_p1 == doctest::Approx(45));
}

TEST_CASE(
    "surface measures: triangles without area have no angle, those without three corners none") {
  const Mesh needle{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  CHECK(shape(needle).smallest_angle_p1 == 0);
  CHECK(shape(needle).share_below_5 == 1);
  Mesh sheet = test::grid(3, 3);
  sheet.triangles.push_back({0, 0, 1});
  sheet.positions.push_back(sheet.positions[1]);
  sheet.triangles.push_back({0, 1, 16});
  CHECK(shape(sheet).share_below_5 == 0);
  CHECK(edges(sheet).border == doctest::Approx(12));
  CHECK(shape({}).area == 0);
  CHECK(edges({}).border == 0);
}

TEST_CASE("surface measures depend on no threads, and on pieces by rounding only") {
  const Mesh mesh = test::torus(200, 100);
  const ShapeMeasures one = shape(mesh, 1), four = shape(mesh, 4);
  CHECK(one.area == four.area);
  CHECK(one.volume == four.volume);
  CHECK(one.smallest_angle_p1 == four.smallest_angle_p1);
  CHECK(measure_edge_lengths(mesh, 1).feature == measure_edge_lengths(mesh, 4).feature);
  ShapeMeter meter(2);
  const std::span<const Triangle> all = mesh.triangles;
  meter.add(mesh.positions, all.first(777));
  meter.add(mesh.positions, all.subspan(777));
  CHECK(meter.measures().area == doctest::Approx(one.area));
  CHECK(meter.measures().volume == doctest::Approx(one.volume));
  CHECK(meter.measures().smallest_angle_p1 == one.smallest_angle_p1);
  CHECK(meter.measures().share_below_5 == one.share_below_5);
}
