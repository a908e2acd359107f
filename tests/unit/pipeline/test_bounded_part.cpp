// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

#include "pipeline/beyond_bound.hpp"
#include "pipeline/bounded_finish.hpp"
#include "pipeline/bounded_part.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// The greater distance of both directions.
double farthest(const Mesh& a, const Mesh& b) {
  const HausdorffOptions options{.gap = 1e-4};
  return std::max(bound_distance(a, b, options).lower, bound_distance(b, a, options).lower);
}

Mesh simplified(const Mesh& mesh, double max_error, double certified_error,
                const test::TempFolder& folder) {
  SimplifyParameters parameters;
  parameters.samples = 1000;
  parameters.cost_unit = 1e-9;
  parameters.max_error = max_error;
  parameters.certified_error = certified_error;
  const Stage stage = Stage::create(folder / std::to_string(certified_error));
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  const BoundedPart made = simplify_to_bound({.mesh = mesh}, parameters, context);
  return decode_result(made.file, 0, "the part").mesh;
}

/// A rough sheet full of holes: there is room for errors between the points that simplification
/// looks at.
Mesh rough_sheet(std::uint32_t seed) {
  std::mt19937 random(seed);
  Mesh sheet = test::grid(40, 40);
  for (Vec3& p : sheet.positions) p.z = 3 * static_cast<double>(random()) / std::mt19937::max();
  std::erase_if(sheet.triangles, [&](const Triangle&) { return random() % 4 == 0; });
  return sheet;
}

}  // namespace

TEST_CASE("what is made of a part is near it everywhere, not at points only") {
  const test::TempFolder folder;
  constexpr double k_bound = 1;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Mesh sheet = rough_sheet(seed);
    const Mesh made = simplified(sheet, k_bound, 0, folder);
    CHECK(made.triangles.size() < sheet.triangles.size() / 2);
    CHECK(farthest(sheet, made) <= k_most_beyond_of_part * k_bound);
  }
}

TEST_CASE("a part keeps more where what is simplified is not within what is to be proven") {
  const Mesh torus = test::torus(60, 40);
  const test::TempFolder folder;
  const Mesh sampled = simplified(torus, 0.05, 0, folder);
  CHECK(farthest(torus, sampled) > 0.04);
  std::size_t before = sampled.triangles.size();
  // The first tries fail; at 1e-7 only the part itself is within the distance to be proven.
  for (const double certified : {0.025, 1e-7}) {
    CAPTURE(certified);
    const Mesh proven = simplified(torus, 0.05, certified, folder);
    CHECK(farthest(torus, proven) <= certified);
    CHECK(proven.triangles.size() > before);
    before = proven.triangles.size();
  }
  CHECK(before == torus.triangles.size());
}

TEST_CASE("a finish leaves as it was stitched what is not within what is to be proven") {
  const Mesh torus = test::torus(60, 40);
  const test::TempFolder folder;
  test::MemorySource source(torus);
  const Stage stage = Stage::create(folder / "stage");
  const Manifest manifest = cut_mesh(source, stage, {.parts = 2});
  const StitchedMesh stitched{
      torus, std::vector<std::uint8_t>(torus.positions.size(), 1), {}, 0, {}};
  const auto finished = [&](double certified_error) {
    return finish_to_bound(stage, manifest, stitched,
                           {.max_error = 0.05,
                            .certified_error = certified_error,
                            .lines = {},
                            .threads = 2,
                            .progress = [](std::uint64_t) {}})
        .mesh;
  };
  const Mesh sampled = finished(0);
  CHECK(farthest(torus, sampled) > 0.04);
  for (const double certified : {0.044, 0.02}) {
    CAPTURE(certified);
    const Mesh proven = finished(certified);
    CHECK(farthest(torus, proven) <= certified);
    CHECK(proven.triangles.size() >= sampled.triangles.size());
  }
  CHECK(finished(1e-7).triangles.size() == torus.triangles.size());
}
