// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A small corpus of all kinds of meshes: to be good on scans alone is not enough.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/simplify.hpp>

using namespace meshfarm;

namespace {

constexpr std::uint64_t k_triangles = 40'000;

/// The greater RMS of both directions, as a fraction of the diagonal.
double error_of(const Mesh& original, const Mesh& result) {
  DistanceOptions options;
  options.samples = 50'000;
  Box box;
  for (const Vec3& p : original.positions) box.add(p);
  return std::max(measure_distance(original, result, options).rms,
                  measure_distance(result, original, options).rms) /
         box.diagonal();
}

/// The ratio to which a shape is reduced, and the highest RMS allowed, in millionths of the
/// diagonal: about 1.3 times the RMS when the row was written. That RMS was about as low as the
/// best of CGAL, VTK, OpenMesh and meshoptimizer, or lower.
struct Row {
  std::string_view shape;
  double ratio;
  double most;
};

constexpr std::array<Row, 21> k_corpus{{
    {"torus", 0.1, 222},     {"torus", 0.03, 605},    {"torus", 0.01, 1560}, {"foam", 0.1, 1725},
    {"foam", 0.03, 5480},    {"foam", 0.01, 14640},   {"dust", 0.5, 44},     {"dust", 0.1, 670},
    {"soup", 0.5, 14800},    {"soup", 0.1, 30800},    {"soup", 0.03, 32200}, {"terrain", 0.1, 515},
    {"terrain", 0.03, 1470}, {"terrain", 0.01, 3680}, {"block", 0.5, 0.001}, {"block", 0.1, 62},
    {"block", 0.03, 262},    {"block", 0.01, 1580},   {"shell", 0.1, 326},   {"shell", 0.03, 1020},
    {"shell", 0.01, 2820},
}};

}  // namespace

TEST_CASE("simplify corpus: the count is met, and the error of both directions is bounded") {
  for (const Row& row : k_corpus) {
    CAPTURE(row.shape);
    CAPTURE(row.ratio);
    const Mesh original = in_memory(*generate_mesh(shape_named(row.shape), k_triangles));
    const double asked = std::round(row.ratio * static_cast<double>(original.triangles.size()));
    SimplifyOptions options;
    options.positions = PositionType::float32;
    Simplifier simplifier(original, options);
    simplifier.reduce({.triangles = static_cast<std::uint64_t>(asked)});
    // A closed surface has an even number of triangles.
    CHECK(std::fabs(static_cast<double>(simplifier.triangles()) - asked) <= 1);
    CHECK(1e6 * error_of(original, simplifier.mesh()) <= row.most);
  }
}
