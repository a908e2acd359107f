// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "pipeline/bound_proof.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Mesh lifted(Mesh mesh, double by) {
  for (Vec3& p : mesh.positions) p.z += by;
  return mesh;
}

}  // namespace

TEST_CASE("proof of a bound: it holds within the distance, in both directions") {
  const Mesh sheet = test::grid(6, 6);
  const BoundProof proof(sheet, 0.5, 1);
  CHECK(proof.holds_for(sheet));
  CHECK(proof.holds_for(lifted(sheet, 0.49)));
  CHECK_FALSE(proof.holds_for(lifted(sheet, 0.51)));
  CHECK_FALSE(proof.holds_for(test::grid(6, 7)));
  CHECK_FALSE(proof.holds_for(test::grid(6, 5)));
  CHECK(BoundProof(sheet, 1.01, 1).holds_for(test::grid(6, 5)));
}

TEST_CASE("proof of a bound: nothing is only near nothing, and lines and points are nothing") {
  const Mesh lines = {{{0, 0, 0}, {9, 9, 9}}, {{0, 0, 1}, {1, 1, 1}}};
  const Mesh sheet = test::grid(2, 2);
  for (const Mesh& empty : {Mesh{}, lines}) {
    const BoundProof proof(empty, 1, 1);
    CHECK(proof.holds_for({}));
    CHECK_FALSE(proof.holds_for(sheet));
  }
  CHECK_FALSE(BoundProof(sheet, 1e9, 1).holds_for({}));
  Mesh both = sheet;
  test::append(both, lines);
  CHECK(BoundProof(both, 0.1, 1).holds_for(sheet));
}
