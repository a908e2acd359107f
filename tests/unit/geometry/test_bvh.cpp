// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <ctime>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>

#include "geometry/bvh.hpp"
#include "geometry/random_unit.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

double squared_by_trying_all(const Mesh& mesh, Vec3 p) {
  double squared = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    squared = std::min(
        squared, squared_distance(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  }
  return squared;
}

/// CPU time, as others may use the machine, too.
double seconds_to_measure(const Mesh& from, const Mesh& to) {
  const std::clock_t start = std::clock();
  measure_distance(from, to, {.samples = 20'000, .threads = 1});
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

TEST_CASE("the nearest triangle is found beside one that is far away, and from far away") {
  for (const double far : {1.0, 1e5, 1e8, 1e16, 1e38}) {
    CAPTURE(far);
    const Mesh mesh = test::with_outlier(test::icosphere(3), far);
    const Bvh bvh(mesh, 1);
    for (std::uint64_t i = 0; i < 200; ++i) {
      const Vec3 place =
          Vec3{random_unit(3 * i), random_unit(3 * i + 1), random_unit(3 * i + 2)} * 3 -
          Vec3{1, 1, 1};
      const Vec3 p = i % 4 == 0 ? place * far : place;
      const Bvh::Nearest found = bvh.nearest(p, 0);
      const double least = squared_by_trying_all(mesh, p);
      CHECK(found.squared >= least);
      CHECK(found.squared <= least * (1 + 1e-5));
    }
  }
}

TEST_CASE("one far vertex makes no search slow, nor do points that are all far away") {
  const Mesh mesh = test::icosphere(6);
  const double usual = seconds_to_measure(mesh, mesh);
  for (const double far : {1e8, 1e16, 1e38}) {
    CAPTURE(far);
    const Mesh with_outlier = test::with_outlier(mesh, far);
    // Nearly all points are on the one long triangle.
    CHECK(seconds_to_measure(with_outlier, mesh) < 20 * usual + 1);
    CHECK(seconds_to_measure(mesh, with_outlier) < 20 * usual + 1);
    CHECK(seconds_to_measure(with_outlier, with_outlier) < 20 * usual + 1);
  }
}
