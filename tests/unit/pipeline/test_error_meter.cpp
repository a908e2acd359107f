// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/value_error.hpp>

#include "pipeline/error_meter.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

Manifest divide(const Mesh& mesh, Scheme scheme, const Stage& stage) {
  test::MemorySource source(mesh);
  if (scheme == Scheme::cut) return cut_mesh(source, stage, {.parts = 5});
  return cut_mesh(source, stage, {.scheme = Scheme::stream, .parts = 5, .window_triangles = 4'000});
}

/// Measures a result against an input that is divided by the scheme.
MeasuredError measure(const Mesh& input, const Mesh& result, Scheme scheme, unsigned threads = 2) {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const Manifest manifest = divide(input, scheme, stage);
  const SurfaceSamples samples = sample_surface(input, {.samples = 20'000});
  return ErrorMeter(stage, manifest, {samples}, threads).measure(result);
}

void check_alike(const Distance& told, const Distance& expected) {
  CHECK(told.rms == doctest::Approx(expected.rms).epsilon(0.03));
  CHECK(told.mean == doctest::Approx(expected.mean).epsilon(0.03));
  CHECK(told.max >= 0.9 * expected.max);
}

}  // namespace

TEST_CASE("a coarse sphere is measured both ways as two meshes in memory are, by either scheme") {
  const Mesh fine = test::icosphere(6);
  const Mesh coarse = test::icosphere(2);
  for (const Scheme scheme : {Scheme::cut, Scheme::stream}) {
    const MeasuredError told = measure(fine, coarse, scheme);
    check_alike(told.to_output, measure_distance(fine, coarse, {}));
    check_alike(told.to_input, measure_distance(coarse, fine, {}));
    CHECK(told.greater().max == std::max(told.to_output.max, told.to_input.max));
    CHECK(told.input_samples == 20'000);
    CHECK(told.output_samples > 0);
  }
}

TEST_CASE("a vertex that was pulled out of the result is told, however thin the spike") {
  const Mesh sheet = test::grid(120, 80);
  Mesh spiked = sheet;
  spiked.positions[60 * 121 + 40].z = 30;
  for (const Scheme scheme : {Scheme::cut, Scheme::stream}) {
    const MeasuredError same = measure(sheet, sheet, scheme);
    CHECK(same.greater().max < 1e-9);
    const MeasuredError told = measure(sheet, spiked, scheme);
    CHECK(told.to_output.max < 1);
    CHECK(told.to_input.max == doctest::Approx(30));
    CHECK(told.to_input.rms ==
          doctest::Approx(measure_distance(spiked, sheet, {}).rms).epsilon(0.1));
  }
}

TEST_CASE("a vertex of the input that the result lost is told") {
  const Mesh sheet = test::grid(120, 80);
  Mesh spiked = sheet;
  spiked.positions[60 * 121 + 40].z = 30;
  for (const Scheme scheme : {Scheme::cut, Scheme::stream}) {
    CHECK(measure(spiked, sheet, scheme).to_output.max == doctest::Approx(30));
  }
}

TEST_CASE("so is one of many, and one of many that the result pulled out") {
  const Mesh sheet = test::grid(300, 300);
  for (const std::size_t vertex : {45'189U, 45'190U, 45'191U}) {
    Mesh spiked = sheet;
    spiked.positions[vertex].z = 30;
    CHECK(measure(spiked, sheet, Scheme::cut).to_output.max == doctest::Approx(30));
    CHECK(measure(sheet, spiked, Scheme::cut).to_input.max == doctest::Approx(30));
  }
}

TEST_CASE("what is farthest between the corners of a large triangle is found, in both directions") {
  // A lid over a narrow pit: no point of it is farther from the sheet than those over the middle.
  const Mesh lid = {.positions = {{0, 0, 0}, {880, 0, 0}, {0, 880, 0}}, .triangles = {{0, 1, 2}}};
  Mesh pit = test::grid(180, 180);
  for (Vec3& p : pit.positions) p = {5 * p.x, 5 * p.y, p.x == 41 && p.y == 52 ? -40.0 : 0.0};
  std::erase_if(pit.triangles, [&](const Triangle& t) {
    return pit.positions[t[0]].x + pit.positions[t[0]].y > 890;
  });
  const double farthest =
      measure_error({lid, {}}, {pit, {}}, {}, {.samples = 400'000}).distance.max;
  CHECK(measure(pit, lid, Scheme::cut).to_input.max > 0.98 * farthest);
  CHECK(measure(lid, pit, Scheme::cut).to_output.max > 0.98 * farthest);
}

TEST_CASE("the same figures from any number of threads") {
  const Mesh fine = test::torus(120, 60);
  const Mesh coarse = test::torus(30, 15);
  for (const Scheme scheme : {Scheme::cut, Scheme::stream}) {
    const MeasuredError one = measure(fine, coarse, scheme, 1);
    const MeasuredError three = measure(fine, coarse, scheme, 3);
    for (const auto direction : {&MeasuredError::to_output, &MeasuredError::to_input}) {
      CHECK((one.*direction).rms == (three.*direction).rms);
      CHECK((one.*direction).mean == (three.*direction).mean);
      CHECK((one.*direction).max == (three.*direction).max);
    }
  }
}

TEST_CASE("normals of a run are those of two meshes in memory, by either scheme") {
  const Mesh fine = test::torus(300, 150);
  const Mesh coarse = test::torus(30, 15);
  const SurfaceError expected = measure_error({fine, {}}, {coarse, {}}, {}, {});
  for (const Scheme scheme : {Scheme::cut, Scheme::stream}) {
    const MeasuredError told = measure(fine, coarse, scheme);
    REQUIRE(told.to_output_normals);
    CHECK(told.normal_samples > 1'900);
    CHECK(told.normal_samples <= 2'000);
    CHECK(told.to_output_normals->rms == doctest::Approx(expected.normals->rms).epsilon(0.03));
    CHECK(told.to_output_normals->p95 == doctest::Approx(expected.normals->p95).epsilon(0.03));
    CHECK(told.to_output_normals->over_90 == 0);
    const MeasuredError again = measure(fine, coarse, scheme, 1);
    CHECK(again.to_output_normals->rms == told.to_output_normals->rms);
    CHECK(again.to_output_normals->p95 == told.to_output_normals->p95);
  }
}

TEST_CASE("of triangles of unequal size normals count by area") {
  Mesh sheet = test::grid(200, 100);  // the left half leans in the result, and is denser
  for (Vec3& p : sheet.positions) p.x = p.x < 100 ? p.x * 0.5 : p.x - 50;
  Mesh leaning = sheet;
  for (Vec3& p : leaning.positions) p.z = p.x < 50 ? 0.02 * (50 - p.x) : 0;
  const MeasuredError told = measure(sheet, leaning, Scheme::cut);
  const double degrees = std::atan(0.02) * 180 / 3.14159265358979323846;
  REQUIRE(told.to_output_normals);
  CHECK(told.to_output_normals->rms == doctest::Approx(degrees * std::sqrt(1.0 / 3)).epsilon(0.03));
  CHECK(told.to_output_normals->p95 == doctest::Approx(degrees).epsilon(0.001));
}

TEST_CASE("a large triangle counts by its area beside many small ones, wherever it comes") {
  for (const std::size_t left_out : {0, 1, 2}) {
    Mesh mesh = test::icosphere(7);
    mesh.triangles.resize(mesh.triangles.size() - left_out);
    test::append(mesh,
                 {.positions = {{5, 0, 0}, {105, 0, 0}, {105, 100, 0}}, .triangles = {{0, 1, 2}}});
    Mesh inside_out = mesh;
    for (std::size_t t = 0; t + 1 < mesh.triangles.size(); ++t) {
      std::swap(inside_out.triangles[t][0], inside_out.triangles[t][1]);
    }
    const MeasuredError told = measure(mesh, inside_out, Scheme::cut);
    REQUIRE(told.to_output_normals);
    CHECK(told.normal_samples > 1'500);
    CHECK(told.to_output_normals->over_90 == doctest::Approx(4 * 3.14159 / 5e3).epsilon(0.4));
    CHECK(told.to_output_normals->p95 < 1e-3);
  }
}

TEST_CASE("an empty result has no error to tell") {
  const MeasuredError told = measure(test::icosphere(3), {}, Scheme::cut);
  CHECK(told.input_samples == 0);
}
