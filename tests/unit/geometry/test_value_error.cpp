// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

constexpr DistanceOptions k_options{.samples = 20'000, .threads = 2};
const std::vector<ValueGroup> k_number = {{ValueKind::numbers, 1}};
const std::vector<ValueGroup> k_vector = {{ValueKind::direction, 3}};

template <class Value>
std::vector<float> values_there(const Mesh& mesh, Value value) {
  std::vector<float> values;
  for (const Vec3& p : mesh.positions) values.push_back(static_cast<float>(value(p)));
  return values;
}

std::vector<float> vectors(const Mesh& mesh, Vec3 direction) {
  std::vector<float> values;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (const double x : {direction.x, direction.y, direction.z}) {
      values.push_back(static_cast<float>(x));
    }
  }
  return values;
}

}  // namespace

TEST_CASE("what is linear is the same on any triangles of a plane") {
  const Mesh fine = test::grid(12, 12);
  Mesh coarse = test::grid(3, 3);
  for (Vec3& p : coarse.positions) p = p * 4;
  const auto slope = [](Vec3 p) { return 0.05 * p.x - 0.02 * p.y + 0.3; };
  const std::vector<float> of_fine = values_there(fine, slope);
  const std::vector<float> of_coarse = values_there(coarse, slope);
  const ValuedMesh a{fine, of_fine};
  const ValuedMesh b{coarse, of_coarse};
  for (const SurfaceError& error :
       {measure_error(a, b, k_number, k_options), measure_error(b, a, k_number, k_options)}) {
    CHECK(error.values[0].samples == k_options.samples);
    CHECK(error.values[0].max < 1e-6);
    CHECK(error.distance.max < 1e-12);
  }
}

TEST_CASE("a slope against none has the error that the formula says") {
  const Mesh sheet = test::grid(10, 10);
  const std::vector<float> slope = values_there(sheet, [](Vec3 p) { return p.x / 10; });
  const std::vector<float> none(sheet.positions.size(), 0);
  const ValueError error =
      measure_error({sheet, slope}, {sheet, none}, k_number, k_options).values[0];
  CHECK(error.mean == doctest::Approx(0.5).epsilon(0.01));
  CHECK(error.rms == doctest::Approx(1 / std::sqrt(3)).epsilon(0.01));
  CHECK(error.max <= 1);
  CHECK(error.max > 0.98);
}

TEST_CASE("the columns of a group are compared as one, those of another by themselves") {
  const Mesh sheet = test::grid(4, 4);
  std::vector<float> a;
  std::vector<float> b;
  for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
    a.insert(a.end(), {0, 0, 0, 5});
    b.insert(b.end(), {3, 0, 0, 7});
  }
  const std::vector<ValueGroup> groups = {{ValueKind::numbers, 3}, {ValueKind::numbers, 1}};
  const SurfaceError error = measure_error({sheet, a}, {sheet, b}, groups, k_options);
  REQUIRE(error.values.size() == 2);
  CHECK(error.values[0].rms == doctest::Approx(std::sqrt(3)));
  CHECK(error.values[0].mean == doctest::Approx(1));
  CHECK(error.values[0].max == doctest::Approx(3));
  CHECK(error.values[1].rms == doctest::Approx(2));
}

TEST_CASE("directions differ by an angle, however long they are") {
  const Mesh sheet = test::grid(4, 4);
  const double turn = 30 * std::acos(-1.0) / 180;
  const std::vector<float> up = vectors(sheet, {0, 0, 2});
  const std::vector<float> tilted = vectors(sheet, {std::sin(turn), 0, std::cos(turn)});
  const ValueError error =
      measure_error({sheet, up}, {sheet, tilted}, k_vector, k_options).values[0];
  CHECK(error.mean == doctest::Approx(30).epsilon(1e-5));
  CHECK(error.max == doctest::Approx(30).epsilon(1e-5));
  const std::vector<float> down = vectors(sheet, {0, 0, -1});
  CHECK(measure_error({sheet, up}, {sheet, down}, k_vector, k_options).values[0].max ==
        doctest::Approx(180));
}

TEST_CASE("points where a surface has no value are left out") {
  const Mesh sheet = test::grid(10, 10);
  std::vector<float> half = values_there(sheet, [](Vec3) { return 1; });
  for (std::size_t v = 0; v < half.size(); ++v) {
    if (sheet.positions[v].x > 5) half[v] = std::numeric_limits<float>::quiet_NaN();
  }
  const std::vector<float> none(sheet.positions.size(), 0);
  const ValueError error =
      measure_error({sheet, half}, {sheet, none}, k_number, k_options).values[0];
  CHECK(error.samples == doctest::Approx(k_options.samples / 2.0).epsilon(0.01));
  CHECK(error.rms == doctest::Approx(1));
  const std::vector<float> zero = vectors(sheet, {0, 0, 0});
  const std::vector<float> up = vectors(sheet, {0, 0, 1});
  const ValueError no_direction =
      measure_error({sheet, up}, {sheet, zero}, k_vector, k_options).values[0];
  CHECK(no_direction.samples == 0);
  CHECK(no_direction.max == 0);
}

TEST_CASE("the greatest distance is found between samples: at a corner, on a side, and inside") {
  const Mesh sheet = test::grid(60, 40);
  Mesh spiked = sheet;
  spiked.positions[20 * 61 + 30].z = 7;
  const DistanceOptions few{.samples = 50};
  CHECK(measure_error({spiked, {}}, {sheet, {}}, {}, few).distance.max == doctest::Approx(7));
  // The middles of the coarse ring's sides and faces are farthest from the fine one.
  const Mesh fine = test::torus(600, 300);
  const Mesh coarse = test::torus(24, 12);
  const DistanceBounds bounds = bound_distance(coarse, fine, {.gap = 1e-6});
  const double found = measure_error({coarse, {}}, {fine, {}}, {}, {.samples = 2'000}).distance.max;
  CHECK(found <= bounds.upper);
  CHECK(found > 0.9999 * bounds.lower);
}

TEST_CASE("a triangle with two corners at one place is no surface that anything is far from") {
  const Mesh sheet = test::grid(60, 40);
  Mesh with_point = sheet;
  test::append(with_point, {.positions = {{5, 5, 30}, {5, 5, 30}, {6, 5, 30}},
                            .triangles = {{0, 1, 2}, {0, 0, 0}}});
  CHECK(measure_error({with_point, {}}, {sheet, {}}, {}, {.samples = 50}).distance.max == 0);
}

TEST_CASE("distances are those without values, and threads change nothing") {
  const Mesh fine = test::icosphere(4);
  const Mesh coarse = test::icosphere(2);
  const std::vector<float> a = values_there(fine, [](Vec3 p) { return p.x; });
  const std::vector<float> b = values_there(coarse, [](Vec3 p) { return p.x; });
  const Distance distance = measure_distance(fine, coarse, k_options);
  const SurfaceError one =
      measure_error({fine, a}, {coarse, b}, k_number, {.samples = 20'000, .threads = 1});
  const SurfaceError more =
      measure_error({fine, a}, {coarse, b}, k_number, {.samples = 20'000, .threads = 4});
  CHECK(one.distance.rms == distance.rms);
  CHECK(one.distance.mean == distance.mean);
  CHECK(one.distance.max >= distance.max);
  CHECK(one.distance.max == more.distance.max);
  CHECK(one.values[0].rms == more.values[0].rms);
  CHECK(one.values[0].max == more.values[0].max);
  CHECK(one.values[0].rms > 0.001);
}

TEST_CASE("without samples or area there is nothing to compare") {
  const Mesh sheet = test::grid(2, 2);
  const std::vector<float> values(sheet.positions.size(), 0);
  CHECK_THROWS_AS(measure_error({sheet, values}, {sheet, values}, k_number, {.samples = 0}),
                  UsageError);
  const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  const std::vector<float> of_flat(3, 0);
  CHECK_THROWS_AS(measure_error({flat, of_flat}, {sheet, values}, k_number, k_options), DataError);
  CHECK_THROWS_AS(measure_error({sheet, values}, {flat, of_flat}, k_number, k_options), DataError);
}

namespace {

NormalDeviation normals(const Mesh& from, const Mesh& to) {
  const SurfaceError error = measure_error({from, {}}, {to, {}}, {}, k_options);
  REQUIRE(error.normals);
  return *error.normals;
}

Mesh turned_over(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

/// A roof over the sheet of 10 x 10 squares: its ridge at x = 5, both sides at that slope.
Mesh roof(double degrees) {
  Mesh mesh = test::grid(10, 10);
  const double slope = std::tan(degrees * std::acos(-1.0) / 180);
  for (Vec3& p : mesh.positions) p.z = 20 + slope * (5 - std::abs(p.x - 5));
  return mesh;
}

Mesh scaled_by(Mesh mesh, double by) {
  for (Vec3& p : mesh.positions) p = p * by;
  return mesh;
}

}  // namespace

TEST_CASE("quantiles of distances are those of a slope") {
  Mesh slope = test::grid(10, 10);
  for (Vec3& p : slope.positions) p.z = p.x / 10;
  const Mesh sheet = test::grid(10, 10);
  const SurfaceError error = measure_error({slope, {}}, {sheet, {}}, {}, k_options);
  CHECK(error.quantiles.p95 == doctest::Approx(0.95).epsilon(0.001));
  CHECK(error.quantiles.p99 == doctest::Approx(0.99).epsilon(0.001));
  CHECK(error.distance.max <= 1);
}

TEST_CASE("normals differ by the slope of a roof, whichever way it is looked at") {
  for (const double degrees : {1.0, 20.0, 60.0}) {
    CAPTURE(degrees);
    const NormalDeviation down = normals(roof(degrees), test::grid(10, 10));
    CHECK(down.rms == doctest::Approx(degrees).epsilon(1e-4));
    CHECK(down.p95 == doctest::Approx(degrees).epsilon(1e-4));
    CHECK(down.over_90 == 0);
    const NormalDeviation over = normals(turned_over(roof(degrees)), test::grid(10, 10));
    CHECK(over.rms == doctest::Approx(180 - degrees).epsilon(1e-4));
    CHECK(over.over_90 == 1);
  }
  // A tenth of the area is turned over.
  Mesh mixed = test::grid(10, 10);
  for (std::size_t i = 0; i < 20; ++i) std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  const NormalDeviation some = normals(mixed, test::grid(5, 5));
  CHECK(normals(mixed, test::grid(10, 10)).over_90 == doctest::Approx(0.1).epsilon(0.01));
  CHECK(some.p95 == doctest::Approx(180));
  CHECK(normals(mixed, mixed).over_90 == 0);
}

TEST_CASE("of triangles that are equally near the one counts that is turned least") {
  // Points beyond an edge or corner of the small one are equally near to two or three faces.
  const Mesh small = test::octahedron();
  const Mesh large = scaled_by(small, 5);
  CHECK(normals(small, large).rms < 1e-5);
  CHECK(normals(large, small).rms < 1e-5);
  CHECK(normals(scaled_by(test::icosphere(0), 2), test::icosphere(0)).rms < 1e-5);
  // A sheet with two sides.
  Mesh both = test::grid(8, 8);
  test::append(both, turned_over(test::grid(8, 8)));
  CHECK(normals(both, both).rms < 1e-5);
  CHECK(normals(test::grid(4, 4), both).rms < 1e-5);
  CHECK(normals(turned_over(test::grid(4, 4)), both).rms < 1e-5);
  Mesh far = large;
  for (Vec3& p : far.positions) p = p + Vec3{1e5, -1e5, 1e5};
  CHECK(normals(far, far).rms < 1e-3);
}

TEST_CASE("normals of triangles without area do not count") {
  Mesh sheet = test::grid(6, 6);
  sheet.positions.insert(sheet.positions.end(), {{0, 3, 0.5}, {3, 3, 0.5}, {6, 3, 0.5}});
  sheet.triangles.push_back({49, 50, 51});
  const NormalDeviation found = normals(roof(0), sheet);
  CHECK(found.rms < 1e-5);
  const Mesh line{{{0, 0, 30}, {10, 0, 30}, {5, 0, 30}, {0, 99, 0}, {1, 99, 0}, {0, 99, 1}},
                  {{0, 1, 2}, {3, 4, 5}}};
  CHECK(normals(test::grid(10, 10), line).rms == 0);  // none
}

TEST_CASE("quantiles and normals depend on no threads, and distances are as without them") {
  const Mesh fine = test::torus(60, 30), coarse = test::torus(17, 9);
  const auto measured = [&](unsigned threads) {
    return measure_error({fine, {}}, {coarse, {}}, {}, {.samples = 20'000, .threads = threads});
  };
  const SurfaceError one = measured(1), four = measured(4);
  CHECK(one.quantiles.p95 == four.quantiles.p95);
  CHECK(one.quantiles.p99 == four.quantiles.p99);
  CHECK(one.normals->rms == four.normals->rms);
  CHECK(one.normals->p95 == four.normals->p95);
  CHECK(one.quantiles.p95 < one.quantiles.p99);
  CHECK(one.distance.rms == measure_distance(fine, coarse, k_options).rms);
  std::size_t triangles = 0;
  measure_error({fine, {}}, {coarse, {}}, {}, k_options,
                [&](const TriangleIndex& index) { triangles = index.mesh().triangles.size(); });
  CHECK(triangles == coarse.triangles.size());
}
