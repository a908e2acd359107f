// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
//     y ^  free        | held | unsure          A flat sheet of 20 x 6 squares: what lies left of
//       |  0 .. 9        10     11 .. 20        x = 10 may change, what lies right of x = 11 may
//       +-----------------------------> x       be changed by another group.
#include <algorithm>
#include <utility>

#include <doctest/doctest.h>

#include "pipeline/bound_proof.hpp"
#include "pipeline/seam_bound.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

constexpr double k_free_below = 10.5;
constexpr double k_error = 0.3;

Mesh sheet() {
  return test::grid(20, 6);
}

/// The locked vertices come first; either all or none of them are unsure.
SeamMesh seams(bool unsure) {
  SeamMesh seams;
  seams.mesh = sheet();
  std::vector<std::uint8_t> flags;
  for (const Vec3& p : seams.mesh.positions) flags.push_back(p.x < k_free_below ? 1 : 0);
  seams.locked = put_last(seams.mesh, flags);
  if (unsure) seams.end_unsure = seams.locked;
  return seams;
}

BoundedFinishOptions options(double certified) {
  return {.max_error = k_error,
          .certified_error = certified,
          .positions = PositionType::float64,
          .threads = 1,
          .progress = [](std::uint64_t) {}};
}

std::size_t count_between(const Mesh& mesh, double lo, double hi) {
  return static_cast<std::size_t>(
      std::count_if(mesh.positions.begin(), mesh.positions.end(),
                    [&](const Vec3& p) { return p.x > lo && p.x < hi; }));
}

}  // namespace

TEST_CASE("round seams: what is locked stays, the rest goes as far as the bound allows") {
  const BoundedFinish made = simplify_seams(seams(false), sheet(), options(k_error));
  CHECK(count_between(made.mesh, 10.5, 21) == 10 * 7);
  CHECK(count_between(made.mesh, 9.5, 10.5) < 7);
  CHECK(count_between(made.mesh, -1, 9.5) < 10);
  CHECK(BoundProof(sheet(), k_error, 1).holds_for(made.mesh));
}

TEST_CASE("round seams: what others may change proves nothing") {
  const BoundedFinish made = simplify_seams(seams(true), sheet(), options(k_error));
  CHECK(count_between(made.mesh, 10.5, 21) == 10 * 7);
  // What is near the unsure part stays, so the rest can be proven without that part.
  CHECK(count_between(made.mesh, 9.5, 10.5) == 7);
  CHECK(count_between(made.mesh, -1, 9.5) < 20);
  // If nothing is to be proven, nothing is left to others.
  const BoundedFinish sampled = simplify_seams(seams(true), sheet(), options(0));
  CHECK(count_between(sampled.mesh, 9.5, 10.5) < 7);
}

TEST_CASE("round seams: what cannot be proven stays as it was") {
  Mesh input = sheet();
  const std::uint32_t first = static_cast<std::uint32_t>(input.positions.size());
  for (const Vec3 p : {Vec3{3, 3, 2}, Vec3{4, 3, 2}, Vec3{3, 4, 2}}) input.positions.push_back(p);
  input.triangles.push_back({first, first + 1, first + 2});  // farther than the bound from all
  const BoundedFinish made = simplify_seams(seams(false), input, options(k_error));
  CHECK(made.mesh.triangles.size() == sheet().triangles.size());
}

TEST_CASE("round seams: without an input near them they are cleaned") {
  SeamMesh twice = seams(false);
  twice.mesh.triangles.push_back(twice.mesh.triangles.front());
  twice.mesh.positions.push_back({1, 1, 1});
  const BoundedFinish made = simplify_seams(std::move(twice), {}, options(k_error));
  CHECK(made.dropped_duplicate == 1);
  CHECK(made.mesh.triangles.size() == sheet().triangles.size());
  CHECK(made.mesh.positions.size() == sheet().positions.size());
}
